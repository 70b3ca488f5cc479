"""The language server: the answers of `aidl_lang.tools.ide` over its protocol, registered theme by theme."""
