"""The language server: the answers of `aidl_server.ide` over its protocol, registered theme by theme."""
