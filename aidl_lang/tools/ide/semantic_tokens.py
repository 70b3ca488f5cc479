"""The role of each word of a program, for colours that follow its meaning, and the colours that it names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.checking.builtins import ATTRIBUTES, PATTERNS
from aidl_lang.checking.registry import PUBLIC
from aidl_lang.checking.resolving.symbols import SymbolKind, word_meant
from aidl_lang.common.colors import COLOR_NAMES, css_color, rgb
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.references import Mention, mentions
from aidl_lang.tools.ide.workspace import View

# --- The role of each word of a program, for colours that follow its meaning.
#
# Types and modifiers are the standard ones of editors; themes colour them without knowing AIDL.

TYPES = (
    *("comment", "keyword", "string", "number", "operator", "decorator", "namespace", "type", "class"),
    *("function", "method", "parameter", "variable", "property", "enumMember"),
)
MODIFIERS = ("declaration", "readonly", "defaultLibrary")

_OF_KIND = {
    SymbolKind.PARAM: "variable",
    SymbolKind.LET: "variable",
    SymbolKind.VAR: "variable",
    SymbolKind.LOOP: "variable",
    SymbolKind.ARGUMENT: "parameter",
    SymbolKind.GEOMETRY: "variable",
    SymbolKind.STRUCTURE: "class",
    SymbolKind.FUNCTION: "function",
    SymbolKind.SHAPE: "type",
    SymbolKind.CONSTRAINT: "function",
    SymbolKind.TEMPLATE: "class",
    SymbolKind.ALIAS: "function",
    SymbolKind.NAMESPACE: "namespace",
    SymbolKind.BUILTIN: "variable",
    SymbolKind.WORD: "enumMember",
    SymbolKind.FIELD: "property",
}
_READONLY = frozenset({SymbolKind.PARAM, SymbolKind.LET, SymbolKind.LOOP, SymbolKind.ARGUMENT})
_WORD_SIGNS = frozenset({"and", "or", "not"})


@record()
class Colored:
    """A piece of one line of the text, its type (one of TYPES) and its modifiers (of MODIFIERS)."""

    span: Span
    type: str
    modifiers: frozenset[str] = frozenset()


def semantic_tokens(view: View) -> list[Colored]:
    """Returns all tokens of a text in its order, including comments; mere punctuation is left out."""
    names = {m.span.start: _of_mention(view, m) for m in mentions(view)}
    names |= {c.span.start: c for c in _heads(view)}
    tokens = view.tokens
    found = [Colored(comment.span, "comment") for comment in tokens.comments]
    for token in tokens.tokens:
        end = token.end - 1 if token.kind == "CALL" else token.end
        span = view.span(token.start, end)
        if token.start in names and names[token.start].span.end == end:
            found.append(names[token.start])
        elif (kind := _of_token(token.kind, token.text)) is not None:
            found.append(Colored(span, kind))
    found.sort(key=lambda c: c.span.start)
    return [piece for colored in found for piece in _lines(colored)]


def _of_token(kind: str, text: str) -> str | None:
    match kind:
        case "NUMBER":
            return "number"
        case "STRING":
            return "string"
        case "CALL":
            return "function"
        case "NAME":
            return "variable"
        case _ if kind.isalpha() and kind == text:
            return "operator" if kind in _WORD_SIGNS else "keyword"
        case _ if kind == text and not set(kind) & set("{}()[],;:.@"):
            return "operator"
        case _:
            return None


def _heads(view: View) -> Iterator[Colored]:
    """Yields words before names, and after `@`, which name nothing themselves."""
    for node in ast.walk(view.module):
        match node:
            case ast.Structure():
                yield Colored(node.kind_word.span, "keyword")
            case ast.Attribute():
                yield Colored(node.name.span, "decorator")
            case ast.Parameter(type=kind) if kind is not None:
                yield Colored(kind.span, "type")


def _of_mention(view: View, mention: Mention) -> Colored:
    symbol = mention.symbol
    kind = _OF_KIND[symbol.kind]
    modifiers = set()
    if mention.is_declaration:
        modifiers.add("declaration")
    if symbol.kind in _READONLY:
        modifiers.add("readonly")
    declared = symbol.declarations[0].span.source if symbol.declarations else None
    if declared is None or view.is_library(declared):
        modifiers.add("defaultLibrary")
    match mention.node:
        case ast.Call(receiver=receiver):
            if symbol.kind is SymbolKind.BUILTIN:
                kind = "type" if symbol.name in PUBLIC and symbol.name not in PATTERNS else "function"
            if kind == "function" and receiver is not None:
                kind = "method"
        case ast.Member() if symbol.kind is not SymbolKind.NAMESPACE:
            kind = "class" if symbol.kind is SymbolKind.STRUCTURE else "property"
    return Colored(mention.span, kind, frozenset(modifiers))


def _lines(colored: Colored) -> Iterator[Colored]:
    """Yields a piece for each line, as editors want it."""
    start = colored.span.start
    for line in colored.span.text.split("\n"):
        if text := line.rstrip("\r"):
            span = Span(colored.span.source, start, start + len(text))
            yield Colored(span, colored.type, colored.modifiers)
        start += len(line) + 1


# --- The colours in `@color(…)`, and other colours written in their place.


@record()
class Color:
    """The place of a colour in the text, and its red, green and blue from 0 to 255."""

    span: Span
    rgb: tuple[int, int, int]


def colors(view: View) -> list[Color]:
    """Returns the literal colours of a text, in its order."""
    found = []
    for node in ast.walk(view.module):
        if isinstance(node, ast.Attribute) and word_meant(node.name.text, ATTRIBUTES) in ("color", "colour"):
            values = [_literal(argument.value) for argument in node.arguments]
            color = css_color(values) if values and None not in values else None
            if color is not None:
                span = node.arguments[0].value.span.to(node.arguments[-1].value.span)
                found.append(Color(span, rgb(color)))
    return found


def spellings(view: View, span: Span, color: tuple[int, int, int]) -> list[str]:
    """Returns the spellings of a colour at a place: its name if it has one, `#rrggbb`, and three numbers if
    the place has three now.
    """
    names = sorted(name for name in COLOR_NAMES if rgb(name) == color)
    written = [f'"{name}"' for name in names[:1]] + ['"#{:02x}{:02x}{:02x}"'.format(*color)]
    now = view.source.text[span.start : span.end]
    return [", ".join(map(str, color)), *written] if "," in now else written


def _literal(node: ast.Expression) -> object:
    """Returns the value of an argument, a bare word being a text; None for an expression that must be
    evaluated.
    """
    match node:
        case ast.String(value) | ast.Number(value, None, _) | ast.Name(value):
            return value
        case _:
            return None


def as_bytes(parts: Sequence[float]) -> tuple[int, int, int]:
    """Converts red, green and blue from 0 to 1 → from 0 to 255."""
    red, green, blue = (round(255 * min(max(part, 0.0), 1.0)) for part in parts)
    return red, green, blue
