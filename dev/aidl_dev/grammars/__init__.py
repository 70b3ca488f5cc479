"""The exports of the grammar, made of `grammar/aidl.lark`: what `aidl_lang.tools.grammars` hands out."""
