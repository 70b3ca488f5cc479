"""The TextMate grammar, used by VS Code, GitHub and others.

Such a grammar reads line by line, by regular expressions of Oniguruma; what is open over several lines is a
region between two of them. Braces stand in no call and in no list: each region inside a statement ends before
one, so that what is still being written does not colour the rest of the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from aidl_dev.highlighting.scopes import Rule, include, match, region
from aidl_lang.tools.highlighting import called
from aidl_lang.tools.vocabulary import vocabulary

_WORDS = vocabulary()
_LETTER = r"[\p{L}\p{N}_]"
_BEFORE, _AFTER = f"(?<!{_LETTER})", f"(?!{_LETTER})"


def _any(words: Iterable[str]) -> str:
    """Returns a pattern for one of the texts, the longest that fits."""
    longest = sorted(words, key=lambda word: (-len(word), word))
    return f"(?:{'|'.join(map(re.escape, longest))})"


def _word(*words: str) -> str:
    return f"{_BEFORE}{_any(words)}{_AFTER}"


_ANY_NAME = rf"{_BEFORE}[\p{{L}}\p{{Nl}}\p{{No}}_]{_LETTER}*"
_NAME = rf"{_BEFORE}(?!{_any(_WORDS.reserved)}{_AFTER})[\p{{L}}\p{{Nl}}\p{{No}}_]{_LETTER}*"
_EQUALS = "=(?!=)"
_INDEXES = r"(?:\[(?:[^\[\]]|\[(?:[^\[\]]|\[[^\[\]]*\])*\])*\]\s*)*"
_DIGITS = r"(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_KIND = rf"{_BEFORE}(?i:{_any(_WORDS.kind_words)}){_AFTER}"

_STATEMENTS = _word(*(word for word in _WORDS.statements if word not in ("for", "if")))
_BODY = rf"(?=\s*{_INDEXES}(?:\{{|{_word('at', 'rotated')}))"
_STRUCTURE = rf"{_KIND}\s+{_NAME}{_BODY}"
_STOP = rf"(?=[{{}};]|{_STATEMENTS}|{_STRUCTURE})"
"""Ends of a call that is not closed; `for` and `if` may stand in one."""

_DEFINING = ("fn", "shape", "constraint")
"""Declarations that have parameters."""


def grammar() -> Rule:
    """Returns the grammar as data for JSON."""
    return {
        "comment": "Made by `make colours`; do not edit.",
        "name": "AIDL",
        "scopeName": "source.aidl",
        "fileTypes": ["aidl"],
        "patterns": [include("statements")],
        "repository": {name: {"patterns": rules} for name, rules in _repository().items()},
    }


def _repository() -> dict[str, list[Rule]]:
    return {
        "statements": [
            *map(include, ("comments", "attributes", "declarations", "constrain", "imports", "structures")),
            *map(include, ("for", "assignments", "blocks", "expression")),
        ],
        "constraints": [
            *map(include, ("comments", "attributes", "declarations", "constrain", "structures", "for")),
            *map(include, ("constraint_blocks", "expression")),
        ],
        "expression": [
            *map(include, ("comments", "strings", "numbers", "keywords", "calls", "members", "groups")),
            *map(include, ("operators", "names", "punctuation")),
        ],
        "arguments": [
            match(rf"({_NAME})(?=\s*(?::|{_EQUALS}))", "name.argument"),
            *map(include, ("for", "expression")),
        ],
        "parameters": [
            include("comments"),
            match(rf"(:)\s*({_NAME})", "punctuation/colon", "name.type"),
            region("(=)", rf"(?=[,)])|{_STOP}", "expression", begins=["operator.assignment"]),
            match(_NAME, whole="name.parameter"),
            include("expression"),
        ],
        "comments": [
            match("///(?!/).*$", whole="comment.documentation"),
            match("//.*$", whole="comment.line/double-slash"),
            match("#.*$", whole="comment.line/number-sign"),
            {"name": "comment.block.aidl", "begin": r"/\*", "end": r"\*/"},
        ],
        "strings": [_string("double", '"'), _string("single", "'")],
        "numbers": [
            match(
                rf"{_BEFORE}({_DIGITS})({_any(_WORDS.units)})?(?:{_AFTER}|(?={_any(_WORDS.keywords)}{_AFTER}))",
                "number",
                "unit",
            ),
            match(rf"{_BEFORE}({_DIGITS})({_LETTER}+)", "number", "unknown/unit"),
        ],
        "attributes": _attributes(),
        "declarations": _declarations(),
        "structures": _structures(),
        "constrain": _constrain(),
        "imports": _imports(),
        "for": [
            region(
                f"({_word('for')})",
                rf"(?=[\])]|{_word('if')})|{_STOP}",
                match(rf"({_NAME})(?=\s*(?:,\s*{_NAME}\s*)*{_word('in')})", "name.definition/loop"),
                "expression",
                begins=["keyword.control"],
            )
        ],
        "assignments": [match(rf"({_NAME})(?=\s*{_INDEXES}{_EQUALS})", "name.definition")],
        "blocks": [_block("statements")],
        "constraint_blocks": [_block("constraints")],
        "keywords": _keywords(),
        "calls": _calls(),
        "members": [match(rf"(\.)\s*({_ANY_NAME})", "punctuation/accessor", "name.member")],
        "groups": [
            region(opened, rf"({closed})|{_STOP}", "for", "expression", begins=[begin], ends=[end])
            for opened, closed, begin, end in (
                (r"(\()", r"\)", "bracket/parens.begin", "bracket/parens.end"),
                (r"(\[)", r"\]", "bracket/list.begin", "bracket/list.end"),
            )
        ],
        "operators": [
            match(_any(_WORDS.ranges), whole="operator.range"),
            match(_any(_WORDS.comparisons), whole="operator.comparison"),
            match(_any(_WORDS.logic), whole="operator.logic"),
            match(_any(_WORDS.arithmetic), whole="operator.arithmetic"),
            match(_any(_WORDS.assignments), whole="operator.assignment"),
        ],
        "names": [
            match(_word(*_WORDS.everywhere), whole="name.everywhere"),
            match(_word(*_WORDS.modules) + r"(?=\s*\.(?!\.))", whole="name.module"),
            match(_word(*_WORDS.constants), whole="name.constant"),
            match(_NAME, whole="name"),
        ],
        "punctuation": [
            match(",", whole="punctuation/comma"),
            match(";", whole="punctuation/statement"),
            match(":", whole="punctuation/colon"),
            match(r"\.", whole="punctuation/accessor"),
            match("@", whole="attribute.sign"),
            match(r"[\])}]", whole="bracket/stray"),
        ],
    }


def _string(name: str, quote: str) -> Rule:
    inside = [match(r"\\.", whole="escape")]
    return {"name": f"string.quoted.{name}.aidl", "begin": quote, "end": f"{quote}|$", "patterns": inside}


def _keywords() -> list[Rule]:
    classes = {
        "constant.truth": _WORDS.truths,
        "keyword.operator": _WORDS.word_operators,
        "keyword.control": [word for word in _WORDS.control if word != "then"],
        "keyword.clause": _WORDS.clauses,
        "keyword.modifier": _WORDS.modifiers,
        "keyword.demand": _WORDS.demands,
        "keyword.declaration": _WORDS.declarations,
    }
    then = match(rf"{_word('then')}(?!\s*(?:{_EQUALS}|[:.,]))", whole="keyword.control")  # else a name
    return [
        *(match(_word(*words), whole=kind) for kind, words in classes.items()),
        then,
        match(_word("import"), whole="keyword.import"),
    ]


def markdown() -> Rule:
    """Returns the grammar of fenced AIDL blocks in Markdown, as data for JSON."""
    fence = r"(^|\G)(\s*)(`{3,}|~{3,})\s*(?i:(aidl)(?=\s|$)[^`]*)$"
    begins = {
        "3": {"name": "punctuation.definition.markdown"},
        "4": {"name": "fenced_code.block.language.markdown"},
    }
    block: Rule = {
        "name": "markup.fenced_code.block.markdown",
        "begin": fence,
        "beginCaptures": begins,
        "end": r"(^|\G)(\2|\s{0,3})(\3)\s*$",
        "endCaptures": {"3": {"name": "punctuation.definition.markdown"}},
        "patterns": [
            {
                "begin": r"(^|\G)(\s*)(.*)",
                "while": r"(^|\G)(?!\s*([`~]{3,})\s*$)",
                "contentName": "meta.embedded.block.aidl",
                "patterns": [{"include": "source.aidl"}],
            }
        ],
    }
    return {
        "comment": "Made by `make colours`; do not edit.",
        "scopeName": "markdown.aidl.codeblock",
        "injectionSelector": "L:text.html.markdown",
        "fileTypes": [],
        "patterns": [include("fence")],
        "repository": {"fence": {"patterns": [block]}},
    }


def _call(name: str, kind: str, *, sign: str = "", sign_kind: str = "", inside: str = "arguments") -> Rule:
    """Returns a rule for a name, with what may precede it, and the contents of its parentheses."""
    before, begins = (rf"({sign})\s*", [sign_kind]) if sign else ("", [])
    return region(
        rf"{before}({name})[ \t]*(\()",
        rf"(\))|{_STOP}",
        inside,
        begins=[*begins, kind, "bracket/parens.begin"],
        ends=["bracket/parens.end"],
    )


def _calls() -> list[Rule]:
    members: dict[str, list[str]] = {}
    for name, kind in called().items():
        members.setdefault(kind, []).append(name)
    known = [(_word(*names), kind, kind) for kind, names in members.items()]
    return [
        rule
        for name, plain, member in (*known, (_NAME, "call", "call.member"))
        for rule in (_call(name, member, sign=r"\.", sign_kind="punctuation/accessor"), _call(name, plain))
    ]


def _attributes() -> list[Rule]:
    found = []
    for name, kind in ((_word(*_WORDS.attributes), "attribute"), (_NAME, "attribute/unknown")):
        found.append(_call(name, kind, sign="@", sign_kind="attribute.sign"))
        found.append(match(rf"(@)\s*({name})", "attribute.sign", kind))
    return found


def _declarations() -> list[Rule]:
    values = [word for word in _WORDS.declarations if word not in _DEFINING]
    return [
        *(
            match(rf"({_word(word)})\s+({_NAME})", "keyword.declaration", f"name.definition/{word}")
            for word in values
        ),
        *(_definition(word) for word in _DEFINING if word != "constraint"),
        region(  # what follows in braces is a block of constraints
            f"(?={_word('constraint')})",
            rf"(?<=\}})|(?={_STRUCTURE}|{_STATEMENTS})(?!{_word('constraint')})",
            _definition("constraint"),
            "comments",
            "constraint_blocks",
        ),
    ]


def _definition(word: str) -> Rule:
    return _call(
        _NAME,
        f"name.function/{word}",
        sign=_word(word),
        sign_kind="keyword.declaration",
        inside="parameters",
    )


def _structures() -> list[Rule]:
    """Returns rules for a kind and a name; an unknown word counts as a kind before a body or a place."""
    return [
        _call(_NAME, "name.template", sign=_KIND, sign_kind="kind", inside="parameters"),
        match(rf"({_NAME})\s+({_NAME}){_BODY}", "kind", "name.structure"),
        match(rf"({_KIND})\s+({_NAME})(?!\s*{_INDEXES}(?:{_EQUALS}|\.))", "kind", "name.structure"),
    ]


def _constrain() -> list[Rule]:
    word = f"({_word('constrain')})"
    return [
        region(
            rf"{word}(?=\s*(?:\{{|{_word('for', 'if')}))",
            rf"(?<=\}})|(?={_word('then')})",
            "constraints",
            begins=["keyword.demand"],
        ),
        match(rf"{word}\s+({_NAME})(?=\s*{_EQUALS})", "keyword.demand", "name"),
    ]


def _imports() -> list[Rule]:
    return [
        region(
            rf"({_word('import')})(?=\s*{_NAME})",
            rf"({_word('from')})|(?=[=\"'])|{_STOP}",
            "comments",
            match(_NAME, whole="name.definition/import"),
            "punctuation",
            begins=["keyword.import"],
            ends=["keyword.import"],
        ),
        match(rf"(?<=[\"'])\s+({_word('as')})\s+({_NAME})", "keyword.import", "name.definition/import"),
    ]


def _block(inside: str) -> Rule:
    return region(r"(\{)", r"(\})", inside, begins=["bracket/block.begin"], ends=["bracket/block.end"])
