"""The language server: what `aidl_lang.tools.ide` knows, over the Language Server Protocol."""
