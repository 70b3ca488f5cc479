"""The shape of a text: its outline, what can be folded, growing selections, the role of each word."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from aidl_lang.checking.builtins import ATTRIBUTES, PATTERNS
from aidl_lang.checking.symbols import SymbolKind, word_meant
from aidl_lang.checking.types import PUBLIC
from aidl_lang.common.colors import COLOR_NAMES, css_color, rgb
from aidl_lang.common.names import fold, is_spelled_in
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Token
from aidl_server.ide.references import Mention, mentions
from aidl_server.ide.site import around
from aidl_server.ide.workspace import Project, View

# --- The outline of a program, and the search for names in all programs of a project.

MOST_FOUND = 200


@record()
class Entry:
    """A declared thing: `detail` describes it, `span` is all of it, `name_span` its name."""

    name: str
    detail: str
    kind: SymbolKind
    span: Span
    name_span: Span
    children: tuple[Entry, ...] = ()


def outline(view: View) -> list[Entry]:
    """Returns the declarations of a file in order of writing, with those in loops and branches."""
    return list(_entries(view, view.module.statements))


def search(project: Project, query: str) -> list[tuple[View, Entry, str]]:
    """Returns entries whose names have a query's letters in this order, whole names and beginnings first;
    each with its file, and the dotted path of what is around it.
    """
    wanted = fold(query)
    found = [
        (view, entry, container)
        for path in project.workspace.programs()
        if (view := project.view(path)) is not None
        for entry, container in flat(outline(view))
        if is_spelled_in(query, entry.name)
    ]

    def rank(each: tuple[View, Entry, str]) -> tuple[bool, bool, bool, int]:
        name = fold(each[1].name)
        return name != wanted, not name.startswith(wanted), wanted not in name, len(name)

    return sorted(found, key=rank)[:MOST_FOUND]


def flat(entries: Iterable[Entry], container: str = "") -> Iterator[tuple[Entry, str]]:
    """Yields entries and what is in them, each with the dotted path of the one around it."""
    for entry in entries:
        yield entry, container
        yield from flat(entry.children, f"{container}.{entry.name}" if container else entry.name)


def _entries(view: View, statements: Iterable[ast.Statement]) -> Iterator[Entry]:
    for statement in statements:
        match statement:
            case ast.For(body=body):
                yield from _entries(view, body.statements)
            case ast.If(then=then, otherwise=otherwise):
                yield from _entries(view, then.statements)
                yield from _entries(view, otherwise.statements if otherwise else ())
            case ast.Import(alias=alias) if alias is not None:
                detail = statement.path.span.text
                yield Entry(alias.text, detail, SymbolKind.NAMESPACE, statement.span, alias.span)
            case _:
                yield from _declared(view, statement)


def _declared(view: View, node: ast.Statement) -> Iterator[Entry]:
    body: ast.Block | None = None
    indices: Sequence[ast.Expression] = ()
    match node:
        case ast.Structure(parameters=parameters, body=body, indices=indices):
            kind = SymbolKind.STRUCTURE if parameters is None else SymbolKind.TEMPLATE
            detail = node.kind_word.text
        case ast.ShapeDefinition(body=body):
            kind, detail = SymbolKind.SHAPE, "shape"
        case ast.ConstraintDefinition():
            kind, detail = SymbolKind.CONSTRAINT, "constraint"
        case ast.FunctionDefinition(value=value):
            kind, detail = SymbolKind.FUNCTION, value.span.one_line
        case ast.Param(value=value) | ast.Let(value=value) | ast.Var(value=value):
            kind, detail = SymbolKind[type(node).__name__.upper()], value.span.one_line
        case ast.Alias(target=target):
            kind, detail = SymbolKind.ALIAS, target.text
        case ast.Assign(value=value, indices=indices):
            detail = value.callee.text if isinstance(value, ast.Call) else value.span.one_line
            symbol = view.resolution.uses.get(node.name)
            kind = SymbolKind.GEOMETRY if symbol is None else symbol.kind
        case _:
            return
    name = node.name.text + "".join(f"[{index.span.one_line}]" for index in indices)
    children = tuple(_entries(view, body.statements)) if body is not None else ()
    yield Entry(name, detail, kind, node.span, node.name.span, children)


# --- Folding ranges: blocks, calls and lists over several lines, comments, imports.
#
# Brackets are paired in the text itself, so a program that does not parse folds too.

_CLOSES = {"}": "{", "]": "[", ")": "("}


def folds(view: View) -> list[tuple[int, int, str]]:
    """Returns folds by their first line, which stays visible; of two that begin in one line the longer: both
    lines, from 1, and `region`, `comment` or `imports`.
    """
    tokens = view.tokens

    def line(offset: int) -> int:
        return view.source.position(offset)[0]

    comments = [(line(c.span.start), line(c.span.end)) for c in tokens.comments]
    imports = [(line(t.start), line(t.start)) for t in tokens.tokens if t.kind == "import"]
    found: dict[int, tuple[int, int, str]] = {}
    for start, end, kind in (
        *((a, b, "comment") for a, b in _runs(comments)),
        *((a, b, "imports") for a, b in _runs(imports)),
        *((line(a), line(b) - 1, "region") for a, b in _brackets(tokens.tokens)),
    ):
        if end > start and (start not in found or found[start][1] <= end):
            found[start] = start, end, kind
    return sorted(found.values())


def _brackets(tokens: Iterable[Token]) -> Iterator[tuple[int, int]]:
    """Yields the offsets of paired brackets; a closing bracket without an open one is skipped."""
    opened: list[tuple[str, int]] = []
    for token in tokens:
        if token.kind in _CLOSES.values() or token.kind == "CALL":
            opened.append(("(" if token.kind == "CALL" else token.kind, token.start))
        elif (wanted := _CLOSES.get(token.kind)) in [kind for kind, _ in opened]:
            while (pair := opened.pop())[0] != wanted:
                pass
            yield pair[1], token.start


def _runs(lines: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    found: list[tuple[int, int]] = []
    for first, last in lines:
        is_next = found and first <= found[-1][1] + 1
        start = found.pop()[0] if is_next else first
        found.append((start, last))
    return found


# --- Grows a selection from a word to the nodes around it.


def selections(view: View, offset: int) -> list[Span]:
    """Returns the ranges around an offset, from the smallest to the whole file."""
    found: list[Span] = []
    for node in reversed(around(view.module, offset)):
        for span in (*_parts(node, offset), node.span):
            is_around = span.start <= offset <= span.end
            grows = not found or (span.start <= found[-1].start and span.end >= found[-1].end)
            if is_around and grows and (not found or span != found[-1]):
                found.append(span)
    return found


def _parts(node: ast.Node, offset: int) -> list[Span]:
    """Returns the parts of a node that are no nodes: the name of a call, the inside of a block."""
    match node:
        case ast.Call(callee=name) | ast.Member(name=name):
            return [name.span]
        case ast.Block(span=span) if span.text[:1] == "{" and span.end - span.start > 2:
            inside = span.text[1:-1]
            start = span.start + 1 + len(inside) - len(inside.lstrip())
            return [Span(span.source, start, start + len(inside.strip()))] if inside.strip() else []
        case _:
            return []


# --- The role of each word of a program, for colours that follow its meaning.
#
# Types and modifiers are the standard ones of editors; themes colour them without knowing AIDL.

TYPES = (
    *("comment", "keyword", "string", "number", "operator", "decorator", "namespace", "type", "class"),
    *("function", "method", "parameter", "variable", "property", "enumMember"),
)
MODIFIERS = ("declaration", "readonly", "defaultLibrary")

_OF_KIND = {
    **dict.fromkeys(SymbolKind, "variable"),
    **dict.fromkeys((SymbolKind.STRUCTURE, SymbolKind.TEMPLATE), "class"),
    **dict.fromkeys((SymbolKind.FUNCTION, SymbolKind.CONSTRAINT, SymbolKind.ALIAS), "function"),
    SymbolKind.ARGUMENT: "parameter",
    SymbolKind.SHAPE: "type",
    SymbolKind.NAMESPACE: "namespace",
    SymbolKind.WORD: "enumMember",
    SymbolKind.FIELD: "property",
}
_OF_TOKEN = {"NUMBER": "number", "STRING": "string", "CALL": "function", "NAME": "variable"}
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
    if kind in _OF_TOKEN or kind != text:
        return _OF_TOKEN.get(kind)
    if kind.isalpha():
        return "operator" if kind in _WORD_SIGNS else "keyword"
    return None if set(kind) & set("{}()[],;:.@") else "operator"


def _heads(view: View) -> Iterator[Colored]:
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
    start = colored.span.start
    for line in colored.span.text.split("\n"):
        if text := line.rstrip("\r"):
            span = Span(colored.span.source, start, start + len(text))
            yield Colored(span, colored.type, colored.modifiers)
        start += len(line) + 1


# --- The colours in `@color(…)`, and other colours written in their place.


def colors(view: View) -> list[tuple[Span, tuple[int, int, int]]]:
    """Returns the literal colours of a text, in its order: the place of each, and red, green and blue from 0
    to 255.
    """
    found = []
    for node in ast.walk(view.module):
        if isinstance(node, ast.Attribute) and word_meant(node.name.text, ATTRIBUTES) in ("color", "colour"):
            values = [_literal(argument.value) for argument in node.arguments]
            color = css_color(values) if values and None not in values else None
            if color is not None:
                span = node.arguments[0].value.span.to(node.arguments[-1].value.span)
                found.append((span, rgb(color)))
    return found


def spellings(view: View, span: Span, parts: tuple[float, float, float]) -> list[str]:
    """Returns the spellings of a colour, given by its red, green and blue from 0 to 1: its name, `#rrggbb`,
    and three numbers if it has three now.
    """
    color = tuple(round(255 * min(max(part, 0.0), 1.0)) for part in parts)
    names = sorted(name for name in COLOR_NAMES if rgb(name) == color)
    written = [f'"{name}"' for name in names[:1]] + ['"#{:02x}{:02x}{:02x}"'.format(*color)]
    now = view.source.text[span.start : span.end]
    return [", ".join(map(str, color)), *written] if "," in now else written


def _literal(node: ast.Expression) -> object:
    """Returns the value of an argument, a bare word being a text; None for what must be evaluated."""
    match node:
        case ast.String(value) | ast.Number(value, None, _) | ast.Name(value):
            return value
        case _:
            return None
