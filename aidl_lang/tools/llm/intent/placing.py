"""Puts something lost back into the text of a program, and tries whether it still fits."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from itertools import takewhile

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import World
from aidl_lang.geometry.solved import ConstraintReport
from aidl_lang.pipeline import Compiled, Settings, compile
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_expression
from aidl_lang.tools.discretion import Reader
from aidl_lang.tools.llm.intent.changes import Changes, Fate
from aidl_lang.tools.llm.intent.inventory import CONSTRAIN, Inventory, Item, Key, Kind, Path, Step

_INDENT = "    "


def put_back(item: Item, changes: Changes) -> Span | None:
    """Returns the place of a lost item in the later program with it; None if there is none any more."""
    if isinstance(item.node, ast.Placement | ast.Argument):
        return _turned(item, changes)
    home = changes.paths.get(item.home, item.home)
    body = changes.after.bodies.get(home)
    if body is None:
        return None
    words = _words(item, changes, home)
    fate, now = changes.fates[item]
    if fate is Fate.WEAKENED and now is not None and now.wish:
        is_bare = any(step.key == CONSTRAIN for step in now.steps)
        words = words if is_bare else f"constrain {words}"
        return _put(now.span, words, words)
    body, rest = _found(body, item.steps, changes)
    if item.kind in (Kind.STRUCTURE, Kind.GEOMETRY, Kind.PARAM):
        return _after_sibling(item, changes, body, _wrapped(words, rest))
    return _at_end(body, _wrapped(words, rest))


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
    common = takewhile(lambda pair: pair[0] == pair[1], zip(path[:-1], home, strict=False))
    return dotted(path[len(list(common)) :])


def dotted(path: Path) -> str:
    """Returns a path as it is written: `dial.finger[3].rim`."""
    return "".join(p if p.startswith("[") or not i else f".{p}" for i, p in enumerate(path))


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
            text = f"{step.opening} {text} }}"
    return text


def _at_end(body: ast.Block, words: str) -> Span:
    """Inserts before the brace that ends a block, on a line of its own if the brace has one."""
    source, text, brace = body.span.source, body.span.source.text, body.span.end - 1
    line = text.rfind("\n", 0, brace) + 1
    margin = text[line:brace]
    if margin.strip() or line <= body.span.start:
        blank = Span(source, len(text[:brace].rstrip(" ")), brace)
        return _put(blank, f"; {words} " if body.statements else f" {words} ", words)
    return _put(Span(source, line, line), f"{margin}{_INDENT}{words}\n", words)


def _put(span: Span, added: str, words: str) -> Span:
    """Returns the place of words in a program with what is added in place of a span."""
    text = span.source.text
    changed = SourceFile(span.source.name, text[: span.start] + added + text[span.end :])
    start = span.start + added.index(words)
    return Span(changed, start, start + len(words))


def _after_sibling(item: Item, changes: Changes, body: ast.Block, words: str) -> Span:
    """Inserts after the nearest thing that stood above it and still exists, else at a block's beginning."""
    above = 0
    for other in changes.before.items:
        if other is item:
            break
        now = changes.fates[other][1]
        if now is not None and now.node in body.statements:
            above = max(above, now.span.end)
    source, text = body.span.source, body.span.source.text
    at = above or body.span.start + 1
    end = text.find("\n", at)
    rest = text[at:end].strip()
    if end < 0 or (rest and not rest.startswith("//")):
        return _put(Span(source, at, at), f" {words} ", words)
    first = body.statements[0].span.start if body.statements else body.span.start
    line = text.rfind("\n", 0, first) + 1
    margin = text[line:first] if not text[line:first].strip() else _INDENT
    return _put(Span(source, end, end), f"\n{margin}{words}", words)


def _turned(item: Item, changes: Changes) -> Span | None:
    path = changes.paths.get(item.thing)
    owner = changes.after.things[path].node if path is not None else None
    if not isinstance(owner, ast.Structure | ast.Assign):
        return None
    text = owner.span.source.text
    if isinstance(item.node, ast.Argument):
        if not isinstance(owner, ast.Assign) or not isinstance(owner.value, ast.Call):
            return None
        given, names = owner.value.arguments, changes.after.resolution.canonical
        named = (a.value for a in given if a.name and names.get(a.name, a.name.text) == item.word)
        level = next(named, None)
        at = owner.value.span.end - 1
        added = f", {item.text}" if given and not text[:at].rstrip().endswith(",") else item.text
    else:
        level = owner.placement.rotated if owner.placement is not None else None
        if isinstance(owner, ast.Assign):
            at, added = owner.span.end, f" {item.text}"
        else:
            at = owner.body.span.start
            added = f"{'' if text[at - 1].isspace() else ' '}{item.text} "
    if level is not None:
        words = item.text.split(" ", 1)[1]
        return _put(level.span, words, words)
    return _put(Span(owner.span.source, at, at), added, item.text)


# --- Tries whether losses still fit: puts each back, and compiles the program.

_SECONDS = 5.0
"""Seconds for solving once with something put back."""
_PATIENCE = 30.0
"""Seconds of processor time after which nothing more is tried."""
_FAILED, _TIMED_OUT = "E0604", "E0603"
_UNSOLVED = frozenset({"E0601", "E0602", "E0605"})
CONTACTS = frozenset({"W0705", "W0712", "W0736"})
"""Remarks on parts that touch nothing; whatever causes one does not fit."""


class State(StrEnum):
    """The state of a loss."""

    UNTRIED = "untried"  # the program has errors, or there was too much to try
    HOMELESS = "homeless"  # what it speaks of, or the place for it, is not there any more
    IMPLIED = "implied"  # other words say it
    FITS = "fits"
    CONFLICTS = "conflicts"
    MENDED = "mended"  # it was in a conflict, and its replacement was changed to hold


@record()
class Finding:
    """The result of trying a loss.

    parties  the statements that a loss conflicts with, as they are written
    reason   the message about the program with it, if it is no conflict of statements
    """

    state: State
    parties: tuple[str, ...] = ()
    reason: str = ""


UNTRIED = Finding(State.UNTRIED)


class Prober:
    """Tries losses in one program, a limited number and time; items of `clashed` were in a conflict."""

    def __init__(self, world: World | None, settings: Settings, most: int, clashed: Collection[Item]) -> None:
        seconds = min(settings.solving.seconds, _SECONDS)
        self.world, self.left, self.clashed = world, most, clashed
        self.end = time.thread_time() + _PATIENCE
        self.settings = replace(settings, solving=replace(settings.solving, seconds=seconds))

    def compiled(self, source: SourceFile) -> Compiled:
        """Compiles, and counts it."""
        self.left -= 1
        return Reader.of(source).compiled(compile(source, self.world, settings=self.settings))

    def tried(
        self, item: Item, changes: Changes, base: Compiled | None, is_first: bool = False
    ) -> tuple[Finding, tuple[SourceFile, Compiled] | None]:
        """Puts an item back into the program of outcome `base`. The first of several may touch nothing.
        Returns, with what was found, the program with the item and its outcome, where it does no harm.
        """
        is_over = self.left <= 0 or time.thread_time() > self.end
        if is_over or base is None or not stands(base):
            return UNTRIED, None
        own = put_back(item, changes)
        if own is None:
            return Finding(State.HOMELESS), None
        result = self.compiled(own.source)
        new = [d for d in new_errors(changes.before, base, result) if not is_first or d.is_error]
        if any(d.code == _TIMED_OUT for d in new):
            self.left = 0  # each further trial would take as long
            return UNTRIED, None
        if result.model is None:
            return Finding(State.HOMELESS), None
        stated = _stated_in(result, own)
        fate, now = changes.fates[item]
        if new:
            solving = [d for d in new if d.code in _UNSOLVED]
            parties = tuple(_parties(solving, own, result))
            was_rewritten = fate is Fate.REWRITTEN and item in self.clashed
            if was_rewritten and now and _is_mended(stated, now, parties, base):
                return Finding(State.MENDED), None
            return Finding(State.CONFLICTS, parties, "" if solving else new[0].message), None
        implied = _is_implied(stated, item, fate, own, result)
        return Finding(State.IMPLIED if implied else State.FITS), (own.source, result)


def stands(compiled: Compiled | None) -> bool:
    """True for a program that solves; an assert of it may fail."""
    if compiled is None or compiled.model is None or compiled.status != "solved":
        return False
    return all(d.code == _FAILED for d in compiled.errors)


def new_errors(before: Inventory, base: Compiled, result: Compiled) -> Iterator[Diagnostic]:
    """Yields errors that the base lacks, and parts that touch nothing except those that did so `before`."""
    contacts = (d for d in before.diagnostics if d.code in CONTACTS)
    known = Counter(_mark(d) for d in (*base.diagnostics, *contacts))
    for d in result.diagnostics:
        if d.is_error or d.code in CONTACTS:
            mark = _mark(d)
            if not known[mark]:
                yield d
            known[mark] -= 1


def _mark(d: Diagnostic) -> tuple[str, str]:
    """Returns a key of a diagnostic; for contacts the part only, as the distance may change."""
    return d.code, d.message.split("`")[1] if d.code in CONTACTS else d.message


def _parties(errors: list[Diagnostic], own: Span, result: Compiled) -> Iterable[str]:
    """Returns the constraints in a conflict as they are written, except the one that was put back."""
    spans = [span for d in errors for span in (d.span, *(label.span for label in d.secondary)) if span]
    others = (span for span in spans if not span.overlaps(own) and _stated_in(result, span))
    return dict.fromkeys(span.one_line for span in sorted(others, key=lambda span: span.start))


def _is_implied(
    stated: Sequence[ConstraintReport], item: Item, fate: Fate, own: Span, result: Compiled
) -> bool:
    """True if the program says as much without an item; of an inequality, only what replaced it can."""
    if item.kind is not Kind.CONSTRAINT and not (item.kind is Kind.ROTATION and stated):
        return False
    return (fate is Fate.REWRITTEN or _is_exact(stated)) and result.follows(own)


def _is_mended(stated: Sequence[ConstraintReport], now: Item, parties: Sequence[str], base: Compiled) -> bool:
    """True if a replacement asks for as much: an equation, or anything but the opposite of an inequality."""
    heirs = _stated_in(base, now.span)
    if _is_exact(stated):
        return bool(heirs) and _is_exact(heirs)
    return now.text not in parties


def _stated_in(compiled: Compiled, span: Span) -> list[ConstraintReport]:
    constraints = compiled.model.constraints if compiled.model is not None else ()
    text, start, end = span.source.text, span.start, span.end
    return [
        c for c in constraints if c.span.start < end and start < c.span.end and c.span.source.text == text
    ]


def _is_exact(stated: Iterable[ConstraintReport]) -> bool:
    return all(report.exact for report in stated)
