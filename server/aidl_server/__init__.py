"""AIDL in an editor: what editors ask, the language server, the live preview."""
