"""The language server: what `aidl_lang.ide` knows, over the Language Server Protocol."""
