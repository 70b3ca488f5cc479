"""Puts something lost back into the text of a program, at its old place or as near as possible."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.expression_printer import format_expression
from aidl_lang.tools.llm.intent.canonical import Key, Path
from aidl_lang.tools.llm.intent.changes import Changes, Fate
from aidl_lang.tools.llm.intent.inventory import CONSTRAIN, Item, Kind, Step

_INDENT = "    "


@record()
class PutBack:
    """The text with something restored, which stands at `start:end`."""

    text: str
    start: int
    end: int


def put_back(item: Item, changes: Changes) -> PutBack | None:
    """Returns the later program with a lost item; None if it has no place for it any more."""
    if isinstance(item.node, ast.Placement | ast.Argument):
        return _turned(item, changes)
    home = changes.paths.get(item.home, item.home)
    body = changes.after.bodies.get(home)
    if body is None:
        return None
    words = _words(item, changes, home)
    fate, now = changes.fates[item]
    if fate is Fate.WEAKENED and now is not None and now.wish:
        return _instead(now, words)
    body, rest = _found(body, item.steps, changes)
    if item.kind in (Kind.STRUCTURE, Kind.GEOMETRY, Kind.PARAM):
        return _after_sibling(item, changes, body, _wrapped(words, rest))
    return _at_end(body, _wrapped(words, rest))


def _instead(wish: Item, words: str) -> PutBack:
    """Replaces a wish."""
    is_bare = any(step.key == CONSTRAIN for step in wish.steps)
    words = words if is_bare else f"constrain {words}"
    text = wish.span.source.text
    return _inserted(text[: wish.span.start], words, text[wish.span.end :], words)


# --- Words -------------------------------------------------------------------------------------------


def _words(item: Item, changes: Changes, home: Path) -> str:
    """Returns the statement in its author's words, with present names."""
    if item.kind is Kind.STRUCTURE:
        return item.span.text
    names = dict(_new_names(item, changes, home))
    node = item.node
    if isinstance(node, ast.Assign | ast.Param | ast.Assert):
        return _exchanged(item.span, names)
    if isinstance(node, ast.Equation):
        words = " = ".join(format_expression(side, names) for side in (node.left, node.right))
    else:
        words = format_expression(node, names) if names else item.text  # type: ignore[arg-type]
    weight = item.span.source.text[node.span.end : item.span.end]
    return f"prefer {words}{weight}" if item.wish else words


def _exchanged(span: Span, names: Mapping[ast.Node, str]) -> str:
    """Returns the text of a statement with names in it replaced."""
    text = span.text
    for node in sorted(names, key=lambda node: -node.span.start):
        start, end = node.span.start - span.start, node.span.end - span.start
        text = text[:start] + names[node] + text[end:]
    return text


def _new_names(item: Item, changes: Changes, home: Path) -> Iterator[tuple[ast.Node, str]]:
    """Yields the names in an item of things whose path has changed."""
    reader = changes.before.readers[item.home]
    for node in ast.walk(item.node):
        if not isinstance(node, ast.Name | ast.Member):
            continue
        known = reader.reference(node)
        if known is None or known[1]:
            continue
        now = changes.paths.get(known[0])
        if now is None or (now == known[0] and home == item.home):
            continue
        if isinstance(node, ast.Name):
            if (words := _seen_from(now, home)) != node.text:
                yield node, words
        elif now[-1] != known[0][-1]:
            yield node.name, now[-1]


def _seen_from(path: Path, home: Path) -> str:
    """Returns the shortest way to refer to a thing in a structure."""
    common = 0
    while common < min(len(path) - 1, len(home)) and path[common] == home[common]:
        common += 1
    return dotted(path[common:])


def dotted(path: Path) -> str:
    """Returns a path as it is written: `dial.finger[3].rim`."""
    return "".join(p if p.startswith("[") or not i else f".{p}" for i, p in enumerate(path))


# --- Places ------------------------------------------------------------------------------------------


def _found(body: ast.Block, steps: Sequence[Step], changes: Changes) -> tuple[ast.Block, Sequence[Step]]:
    """Returns the innermost block around an item that still exists, and the missing blocks inside it."""
    keys = {s.block: s.key for i in changes.after.items for s in i.steps}
    for n, step in enumerate(steps):
        inner = [block for block, key in _blocks_in(body) if keys.get(block, key) == step.key]
        if not inner:
            return body, steps[n:]
        body = inner[-1]
    return body, ()


def _blocks_in(body: ast.Block) -> Iterator[tuple[ast.Block, Key]]:
    """Yields the blocks with braces directly in a block, each with its key."""
    for statement in body.statements:
        match statement:
            case ast.Constrain(items, braces) if braces:
                yield items, CONSTRAIN
            case ast.For(body=inner):
                yield inner, ()
            case ast.If(then=then, otherwise=otherwise):
                yield from ((block, ()) for block in (then, otherwise) if block is not None)


def _wrapped(text: str, steps: Sequence[Step]) -> str:
    for step in reversed(steps):
        if step.key == CONSTRAIN and step is steps[-1]:
            text = text if text.startswith("prefer ") else f"constrain {text}"
        else:
            text = f"{step.opening} {text} {step.closing}"
    return text


def _at_end(body: ast.Block, words: str) -> PutBack:
    """Inserts before the brace that ends a block, on a line of its own if the brace has one."""
    text, brace = body.span.source.text, body.span.end - 1
    line = text.rfind("\n", 0, brace) + 1
    margin = text[line:brace]
    if margin.strip() or line <= body.span.start:
        before = text[:brace].rstrip(" ")
        return _inserted(before, f"; {words} " if body.statements else f" {words} ", text[brace:], words)
    return _inserted(text[:line], f"{margin}{_INDENT}{words}\n", text[line:], words)


def _inserted(before: str, added: str, after: str, words: str) -> PutBack:
    start = len(before) + added.index(words)
    return PutBack(before + added + after, start, start + len(words))


def _after_sibling(item: Item, changes: Changes, body: ast.Block, words: str) -> PutBack:
    """Inserts after the nearest thing that stood above it and still exists; else at the beginning of the
    block.
    """
    above = 0
    for other in changes.before.items:
        if other is item:
            break
        now = changes.fates[other][1]
        if now is not None and now.node in body.statements:
            above = max(above, now.span.end)
    text = body.span.source.text
    at = above or body.span.start + 1
    end = text.find("\n", at)
    rest = text[at:end].strip()
    if end < 0 or (rest and not rest.startswith("//")):
        return _inserted(text[:at], f" {words} ", text[at:], words)
    first = body.statements[0].span.start if body.statements else body.span.start
    line = text.rfind("\n", 0, first) + 1
    margin = text[line:first] if not text[line:first].strip() else _INDENT
    return _inserted(text[:end], f"\n{margin}{words}", text[end:], words)


def _turned(item: Item, changes: Changes) -> PutBack | None:
    """Returns the later program with the rotation of a thing in its head, or among its arguments."""
    path = changes.paths.get(item.thing)
    owner = changes.after.things[path].node if path is not None else None
    if not isinstance(owner, ast.Structure | ast.Assign):
        return None
    text = owner.span.source.text
    level = _level(item, owner, changes)
    if level is not None:
        words = item.text.split(" ", 1)[1]
        return _inserted(text[: level.span.start], words, text[level.span.end :], words)
    if isinstance(item.node, ast.Argument):
        if not isinstance(owner, ast.Assign) or not isinstance(owner.value, ast.Call):
            return None
        at = owner.value.span.end - 1
        comma = ", " if owner.value.arguments and not text[:at].rstrip().endswith(",") else ""
        return _inserted(text[:at], f"{comma}{item.text}", text[at:], item.text)
    if isinstance(owner, ast.Assign):
        return _inserted(text[: owner.span.end], f" {item.text}", text[owner.span.end :], item.text)
    at = owner.body.span.start
    space = "" if text[at - 1].isspace() else " "
    return _inserted(text[:at], f"{space}{item.text} ", text[at:], item.text)


def _level(item: Item, owner: ast.Structure | ast.Assign, changes: Changes) -> ast.Expression | None:
    """Returns the expression at the place of the rotation."""
    if isinstance(item.node, ast.Placement):
        return owner.placement.rotated if owner.placement is not None else None
    if not isinstance(owner, ast.Assign) or not isinstance(owner.value, ast.Call):
        return None
    names = changes.after.resolution.canonical
    named = (a for a in owner.value.arguments if a.name is not None)
    return next((a.value for a in named if a.name and names.get(a.name, a.name.text) == item.word), None)
