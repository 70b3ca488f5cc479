"""A real tokenizer and a real engine for constrained decoding, and the programs to try them on."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import llguidance

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.tools.grammars import export
from tests.documents import ROOT, programs


class Vocabulary:
    """The tokens of Mistral's tokenizer, its special ones left out."""

    def __init__(self) -> None:
        import mistral_common
        from mistral_common.tokens.tokenizers.base import SpecialTokenPolicy
        from mistral_common.tokens.tokenizers.tekken import Tekkenizer

        tekken = Tekkenizer.from_file(
            str(Path(mistral_common.__file__).parent / "data" / "tekken_240911.json")
        )
        first = tekken.num_special_tokens
        pieces = range(first, tekken.n_words)
        self.tokens = [tekken.id_to_byte_piece(i, SpecialTokenPolicy.KEEP) for i in pieces]
        self.eos_token_id = len(self.tokens)
        self.bos_token_id = None
        self.tokens.append(b"<end>")
        self.special_token_ids = [self.eos_token_id]
        self._first = first
        self._tekken = tekken

    def __call__(self, text: bytes | str) -> list[int]:
        text = text.decode() if isinstance(text, bytes) else text
        return [i - self._first for i in self._tekken.encode(text, bos=False, eos=False)]

    def text(self, tokens: list[int]) -> str:
        return b"".join(self.tokens[i] for i in tokens).decode()


class Engine:
    """llguidance at the beginning of a text, for one grammar."""

    def __init__(self, grammar: str) -> None:
        self.vocabulary, tokenizer = _tokenizer()
        self._matcher = llguidance.LLMatcher(tokenizer, grammar)
        assert not self._matcher.is_error(), self._matcher.get_error()
        assert not self._matcher.get_grammar_warnings()

    def matcher(self) -> llguidance.LLMatcher:
        return self._matcher.deep_copy()

    def takes(self, text: str) -> tuple[int, int, bool]:
        """How many tokens of a text are taken, how many there are, and whether it may end behind the last."""
        tokens = self.vocabulary(text)
        matcher = self.matcher()
        taken = matcher.try_consume_tokens(tokens)
        assert not matcher.is_error(), matcher.get_error()
        return taken, len(tokens), taken == len(tokens) and matcher.is_accepting()


@cache
def _tokenizer() -> tuple[Vocabulary, llguidance.LLTokenizer]:
    vocabulary = Vocabulary()
    return vocabulary, llguidance.LLTokenizer(llguidance.TokenizerWrapper(vocabulary))


@cache
def engine(fenced: bool = False) -> Engine:
    return Engine(export("llguidance", fenced))


@cache
def all_programs() -> dict[str, str]:
    """Examples, the library, and all programs of the documentation, by their places."""
    files = [path for folder in ("examples", "stdlib") for path in sorted((ROOT / folder).rglob("*.aidl"))]
    found = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files}
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        found |= {block.place: block.text for block in programs(page)}
    return found


def syntax_errors(text: str) -> list[str]:
    """The codes of the errors of the parser, E0125 aside: the grammar knows no lines."""
    found = parse(SourceFile("", text)).diagnostics
    return [d.code for d in found if d.is_error and d.code != "E0125"]
