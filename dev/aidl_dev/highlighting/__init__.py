"""The grammars and words for editors, made from the classes of `aidl_lang.tools.highlighting`."""
