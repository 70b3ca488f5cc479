"""The language server: the answers of `aidl_lang.tools.ide` over the Language Server Protocol."""
