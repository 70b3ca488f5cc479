"""Code actions: the fixes that come with diagnostics, and offers to change a program."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from textwrap import dedent, indent

from aidl_lang import parser
from aidl_lang.checking.calls import arguments
from aidl_lang.checking.symbols import IDLE, UNKNOWNS, Symbol, SymbolKind
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold
from aidl_lang.common.prose import fixed
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.export.job import ExportError
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.solved import Box, Motion, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.syntax import ast
from aidl_lang.tools.mending import mend
from aidl_server.ide.guesses import can_write_back, factor, write_back
from aidl_server.ide.references import CannotError, free_name, mentions
from aidl_server.ide.site import around, structures_around
from aidl_server.ide.workspace import (
    View,
    above_comments,
    applied,
    between,
    edited,
    indent_at,
    insert,
    line_start,
)

# Each action is found cheaply and carried out when it is chosen; those that could go wrong try the changed
# program first, and refuse if the result is not what the title promises.


def actions(view: View, start: int, end: int) -> list[Action]:
    """Returns the actions for a selection of the text, or for the cursor if both ends are the same."""
    return [
        *fixes(view, start, end),
        *allowances(view, start, end),
        *missing_constraints(view, start),
        *namings(view, start, end),
        *extractions(view, start),
        *writings(view, start, end),
    ]


@record()
class Action:
    """A code action.

    kind    `quickfix`, `refactor.extract`, `refactor.rewrite` or `source.fixAll`, as editors sort them
    make    returns the edits; raises CannotError
    mends   the diagnostic that it is for
    """

    title: str
    kind: str
    make: Callable[[], Sequence[Edit]]
    mends: Diagnostic | None = None
    is_preferred: bool = False


def first_error(view: View) -> str:
    return next((d.message for d in view.diagnostics if d.is_error), "the drawing would change")


# --- The edits that come with diagnostics, one by one and all together.

_CONFLICTS = frozenset({"E0601", "E0602", "E0603", "E0605"})


def fixes(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields fixes for diagnostics at a selection; for a conflict, those of each constraint in it."""
    places = ((d, (d.span, *(label.span for label in d.secondary))) for d in view.diagnostics)
    near = [d for d, spans in places if any(_is_here(view, span, start, end) for span in spans)]
    offered: list[Fix] = []
    for d in near:
        if d.fix is not None:
            offered.append(d.fix)
            yield _action(d.fix, d, is_preferred=d.is_error and d.fix.is_sure)
    for d in near:
        for fix in _remedies(view, d):
            if fix not in offered:
                offered.append(fix)
                yield _action(fix, d, is_preferred=False)
    if any(d.fix is not None and d.fix.is_sure for d in view.diagnostics):
        yield Action("Apply all fixes", "source.fixAll", partial(_everything, view))


def _is_here(view: View, span: Span | None, start: int, end: int) -> bool:
    return span is not None and span.source is view.source and span.start <= end and start <= span.end


def _remedies(view: View, d: Diagnostic) -> Iterator[Fix]:
    if d.code not in _CONFLICTS or view.outcome is None:
        return
    for conflict in view.outcome.conflicts():
        if any(party.span == d.span for party in conflict.parties):
            yield from (party.fix for party in conflict.parties if party.fix is not None)


def _action(fix: Fix, d: Diagnostic, *, is_preferred: bool) -> Action:
    title = fix.title[:1].upper() + fix.title[1:]
    return Action(title, "quickfix", lambda: fix.edits, d, is_preferred)


def _everything(view: View) -> Sequence[Edit]:
    mended = mend(view.source, view.world)
    if mended.source.text == view.source.text:
        raise CannotError("the fixes stand in files that this one imports, or make nothing better")
    return between(view.source, mended.source.text)


# --- Notes and warnings at a selection, kept from being told by an `@allow` before the statement.


def allowances(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields, for each note and warning at a selection, the action that silences it where it is."""
    for d in view.diagnostics:
        is_note = not d.is_error and d.code != IDLE
        if is_note and d.span is not None and _is_here(view, d.span, start, end):
            yield Action(f"Allow {d.code} here", "quickfix", partial(_allowing, view, d.code, d.span), d)


def _allowing(view: View, code: str, place: Span) -> Sequence[Edit]:
    """Returns the edits that allow a code in the innermost statement about a place that can have it."""
    around = [
        node
        for node in ast.walk(view.resolution.main)
        if isinstance(node, ast.Allowing | ast.Structure | ast.Assign)
        and node.span.start <= place.start
        and place.end <= node.span.end
    ]
    for node in reversed(around):
        edits = [_edit(node, code)]
        changed = SourceFile(view.source.name, applied(view.source.text, edits))
        if not any(d.is_error for d in parser.parse(changed).diagnostics):
            return edits
    raise CannotError("there is no statement about it that could have an `@allow`")


def _edit(node: ast.Allowing | ast.Structure | ast.Assign, code: str) -> Edit:
    source, start = node.span.source, node.span.start
    for attribute in ast.attributes(node):
        if fold(attribute.name.text) == ast.ALLOW and attribute.arguments:
            return insert(source, attribute.arguments[-1].span.end, f', "{code}"')
    before = source.text[line_start(source.text, start) : start]
    between = " " if before.strip() else f"\n{before}"
    return insert(source, start, f'@allow("{code}"){between}')


# --- Writes solved values into the text: at the cursor or selection, and everywhere.

_TITLES = {False: "Write solved values back as first guesses", True: "Write changed sizes back"}


def writings(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields actions for the selection, or the innermost structure at the cursor; and for the whole file."""
    if view.outcome is None:
        return
    places: list[tuple[Span | None, str]] = [(None, "")]
    if start < end:
        places.insert(0, (view.span(start, end), ": selection"))
    elif (node := next(structures_around(view, start), None)) is not None:
        places.insert(0, (node.span, f": `{node.name.text}`"))
    for sizes, title in _TITLES.items():
        for part, where in places:
            if can_write_back(view, part, sizes=sizes):
                made = partial(write_back, view, part, sizes=sizes)
                yield Action(f"{title}{where}", "refactor.rewrite", made)


# --- Names a number: makes it a `param` with a range, which can be set from outside.

_SHORT = 2
"""Length of a name that says too little to be part of another."""


def namings(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields the action for the number at a selection, if a `param` may replace it."""
    path = around(view.module, start)
    number = path[-1]
    if not isinstance(number, ast.Number) or any(isinstance(node, ast.Param) for node in path):
        return
    if end <= number.span.end:
        name = free_name(view, _suggested(view, path))
        title = f"Name this number as a param: `{name}`"
        yield Action(title, "refactor.extract", partial(_named, view, path, number, name))


def _named(view: View, path: Sequence[ast.Node], number: ast.Number, name: str) -> list[Edit]:
    declared = _declared(view, path, f"param {name} = {number.span.text}{_range(number)}")
    edits = [declared, Edit(number.span, name)]
    before, after = view.outcome, edited(view, edits)
    if before is not None and before.ok and not (after.outcome and after.outcome.ok):
        raise CannotError(f"as a param the number is exact, and then: {first_error(after)}")
    return edits


def _range(number: ast.Number) -> str:
    """Returns the range from half to twice the number; none for 0."""
    if not number.value:
        return ""
    low, high = (f"{number.value * share:.3g}" for share in (0.5, 2))
    if number.value.is_integer() and number.unit is None:  # it may count something
        low = str(max(1, int(number.value) // 2))
    unit = number.unit if number.unit and factor(number.unit) != 1.0 else ""
    return f" in {low}{unit}..{high}{unit}" if "e" not in low + high else ""


def _declared(view: View, path: Sequence[ast.Node], line: str) -> Edit:
    """Returns the edit that declares a param visible to the number: with the others of the innermost
    structure that is built once, else of the file.
    """
    text = view.source.text
    home: ast.Module | ast.Structure = view.module
    for node in path[1:]:
        if isinstance(node, ast.Structure) and node.parameters is None and not node.indices:
            home = node if node.body in path else home
            break
        if isinstance(node, ast.Structure | ast.ShapeDefinition | ast.ConstraintDefinition | ast.For):
            break
    statements = home.statements if isinstance(home, ast.Module) else home.body.statements
    inner = path[path.index(home) + 1 :]
    here = next(node for node in inner if node in statements)
    above = [s for s in statements if isinstance(s, ast.Param) and s.span.end <= here.span.start]
    if above:
        last = above[-1].span
        return insert(view.source, last.end, f"\n{indent_at(text, last.start)}{line}")
    if isinstance(home, ast.Module):
        return insert(view.source, above_comments(text, here.span.start), f"{line}\n\n")
    start, first = home.body.span.start + 1, statements[0].span.start
    is_below = "\n" in text[start:first]
    return insert(view.source, start, f"\n{indent_at(text, first)}{line}\n" if is_below else f" {line};")


def _suggested(view: View, path: Sequence[ast.Node]) -> str:
    """Suggests a name for a number by its use: `grip_height`, `hook_x`."""
    words: list[str] = []
    for outer, inner in pairwise(path):
        match outer:
            case ast.Structure(name=name):
                words = [name.text]
            case ast.Assign(name=name) if len(name.text) > _SHORT:
                words = [name.text]
            case ast.Argument(name=name) if name is not None:
                words = [*words[:1], name.text]
            case ast.Call() if (meant := _parameter(view, outer, inner)) is not None:
                words = [*words[:1], meant]
            case ast.Point(x=x):
                words = [*words[:1], "x" if inner is x else "y"]
            case ast.Let(name=name) | ast.Var(name=name):
                words = [name.text, "value"]
            case ast.Placement(rotated=rotated) if inner is rotated:
                words = [*words[:1], "angle"]
    return "_".join(words) if len(words) > 1 else "_".join([*words, "size"])


def _parameter(view: View, call: ast.Call, inner: ast.Node) -> str | None:
    fits = view.program.inference.fits.get(call)
    given = next((a for a in call.arguments if a is inner and a.name is None), None)
    if not fits or given is None:
        return None
    nodes = arguments(view.program.inference, call)
    return fits[0].parameter_of(nodes.index(given.value))


# --- Makes a structure a template: it is drawn as before, and can be used again.

_PASSED = frozenset({SymbolKind.PARAM, SymbolKind.LET, SymbolKind.LOOP, SymbolKind.ARGUMENT})
"""Symbols that can be passed to a template."""


def extractions(view: View, offset: int) -> Iterator[Action]:
    """Yields the action for the structure whose head contains the cursor, if it lies in another structure."""
    path = around(view.module, offset)
    inside = [node for node in path if isinstance(node, ast.Structure)]
    if len(inside) < 2 or inside[-1].parameters is not None or offset > inside[-1].body.span.start:
        return
    name = free_name(view, f"{inside[-1].name.text}_{inside[-1].kind_word.text}")
    title = f"Extract `{inside[-1].name.text}` to a template: `{name}`"
    yield Action(title, "refactor.extract", partial(_extracted, view, inside[-1], path[1], name))


def _extracted(view: View, node: ast.Structure, outermost: ast.Node, name: str) -> list[Edit]:
    passed, text = _passed(view, node), view.source.text
    parameters = ", ".join(symbol.name for symbol in passed)
    template = f"{node.kind_word.text} {name}({parameters}) {_dedented(view, node)}\n\n"
    arguments = ", ".join(f"{symbol.name}: {symbol.name}" for symbol in passed)
    target = text[node.name.span.start : node.indices[-1].span.end] + "]" if node.indices else node.name.text
    placement = f" {node.placement.span.text}" if node.placement is not None else ""
    used = Edit(node.kind_word.span.to(node.span), f"{target} = {name}({arguments}){placement}")
    edits = [insert(view.source, above_comments(text, outermost.span.start), template), used]
    after = edited(view, edits)
    outcomes = [each.outcome for each in (view, after) if each.outcome is not None and each.outcome.ok]
    try:
        pictures = [outcome.export(".svg") for outcome in outcomes]
    except ExportError as reason:
        raise CannotError(str(reason)) from None
    if len(pictures) < 2 or pictures[0] != pictures[1]:
        raise CannotError(f"`{node.name.text}` cannot be made a template as it is: {first_error(after)}")
    return edits


def _dedented(view: View, node: ast.Structure) -> str:
    """Returns the body of a structure indented for the file's level."""
    start, text = node.kind_word.span.start, view.source.text
    margin = text[line_start(text, start) : start]
    lines = node.body.span.text.split("\n")
    if len(lines) == 1 or margin.strip():
        return node.body.span.text
    inner = dedent("\n".join(lines[1:-1]))
    return "\n".join([lines[0], indent(inner, "    "), lines[-1].removeprefix(margin)])


def _passed(view: View, node: ast.Structure) -> list[Symbol]:
    """Returns the outer names that a body uses. Raises CannotError for one that cannot be passed."""
    found: dict[Symbol, None] = {}
    for mention in mentions(view):
        symbol = mention.symbol
        inside = node.body.span.start <= mention.span.start < node.body.span.end
        is_read = inside and isinstance(mention.node, ast.Name | ast.Call)
        if not is_read or not _is_around(view, node, symbol):
            continue
        if symbol.kind not in _PASSED:
            what = "belongs to what is around it" if symbol.kind in UNKNOWNS else "is defined around it"
            raise CannotError(f"`{node.name.text}` uses `{symbol.name}`, which {what}")
        found[symbol] = None
    return list(found)


def _is_around(view: View, node: ast.Structure, symbol: Symbol) -> bool:
    """True for a symbol declared in this file between the file's own level and the structure."""
    here = [d.span for d in symbol.declarations if d.span.source is view.source]
    outside = [s for s in here if not (node.span.start <= s.start < node.span.end)]
    return bool(outside) and symbol.owner is not None and not isinstance(symbol.owner, ast.Module)


# --- Adds a missing constraint: a statement that holds something movable where it is.
#
# An alignment that exists already comes first, else the present number.

_ALIGNED = 1e-6
"""Distance within which places coincide, relative to the size of the drawing."""
_DECIMALS = 3
"""Decimals of a written number: no finer than a micrometre."""
_MOST = 4
"""Motions of a structure for which actions are offered."""
_WRITABLE = re.compile(r"[^\W\d]\w*(\[-?\d+\])*(\.[^\W\d]\w*(\[-?\d+\])*)*")


@record()
class _Thing:
    """Something with a place: its path in the structure, and its box, for a point the point itself."""

    name: str
    box: Box
    is_point: bool

    def at(self, axis: str) -> float:
        """Returns the place of its middle."""
        box = self.box
        return (box.left + box.right) / 2 if axis == "x" else (box.bottom + box.top) / 2

    def written(self, axis: str) -> str:
        return f"{self.name}.{axis}" if self.is_point else f"{self.name}.center.{axis}"


def missing_constraints(view: View, offset: int) -> Iterator[Action]:
    """Yields actions for the innermost structure around the cursor, if something in it can still move."""
    if view.solved is None or not view.solved.holds:
        return
    model = view.solved.model
    node = next((n for n in structures_around(view, offset) if n.parameters is None), None)
    found = [s for s in model.root.walk() if node is not None and s.span == node.span]
    if node is None or len(found) != 1:
        return
    structure, inside = found[0], f"{found[0].path}."
    own = [m for m in model.motions if all(thing.startswith(inside) for thing in m.things)]
    for motion in own[:_MOST]:
        for statement in _statements(model, structure, motion):
            title = f"Add the missing constraint: `{statement}`"
            yield Action(title, "quickfix", partial(_added, view, node, statement))


def _added(view: View, node: ast.Structure, statement: str) -> list[Edit]:
    """Adds the statement to the structure's last `constrain { }`, or to a new one at its end."""
    edits = [_place(view, node, statement)]
    changed = edited(view, edits)
    before, after = view.solved, changed.solved
    if after is None or not after.outcome.ok:
        raise CannotError(f"with `{statement}` the program does not solve: {first_error(changed)}")
    free = before.model.degrees if before is not None else None
    if free is None or (after.model.degrees or 0) >= free:
        raise CannotError(f"`{statement}` would hold nothing that is free")
    return edits


def _place(view: View, node: ast.Structure, statement: str) -> Edit:
    text = view.source.text
    blocks = [s.items for s in node.body.statements if isinstance(s, ast.Constrain) and s.braces]
    if blocks and blocks[-1].statements:
        last = blocks[-1].statements[-1].span
        if "\n" in blocks[-1].span.text:
            return insert(view.source, last.end, f"\n{indent_at(text, last.start)}{statement}")
        return insert(view.source, last.end, f", {statement}")
    end = node.body.span.end - 1
    if "\n" not in node.body.span.text:
        return insert(view.source, end, f" constrain {statement} ")
    outer = indent_at(text, end)
    if text[end - len(outer) - 1 : end] != f"\n{outer}":  # the brace stands behind the last statement
        return insert(view.source, end, f" constrain {statement}\n{outer}")
    return insert(view.source, end - len(outer), f"{outer}    constrain {statement}\n")


def _statements(model: SolvedModel, structure: SolvedStructure, motion: Motion) -> Iterator[str]:
    """Yields statements that would hold one moving thing, the more telling first."""
    things = {thing.name: thing for thing in _things(structure)}
    name = motion.things[0].removeprefix(f"{structure.path}.")
    if not _WRITABLE.fullmatch(name):
        return
    moved = things.get(name)
    match motion.kind:
        case "slide" | "together" if moved is not None:
            axes = {"slide along x": "x", "slide along y": "y"}.get(motion.words, "xy")
            for axis in axes:
                yield from _held(model, structure, things, moved, axis, motion)
        case "grow" if moved is not None:
            side = "width" if motion.words == "grow wider" else "height"
            length = moved.box.width if side == "width" else moved.box.height
            yield f"{name}.{side} == {fixed(length, _DECIMALS)}"
        case "change" if (value := _number_of(structure, name)) is not None:
            yield f"{name} == {fixed(value, _DECIMALS)}"
        case "turn" if (angle := _number_of(structure, f"{name}.angle")) is not None:
            yield f"{name}.angle == {fixed(angle, _DECIMALS)}deg"


def _held(
    model: SolvedModel,
    structure: SolvedStructure,
    things: dict[str, _Thing],
    moved: _Thing,
    axis: str,
    motion: Motion,
) -> Iterator[str]:
    """Yields alignments that hold now, then the present coordinate."""
    moving = [thing.removeprefix(f"{structure.path}.") for thing in motion.things]
    at, whole = moved.at(axis), model.root.box
    near = _ALIGNED * (math.hypot(whole.width, whole.height) if whole is not None else 1.0)
    for name, other in things.items():
        is_apart = not any(name == m or name.startswith(f"{m}.") or m.startswith(f"{name}.") for m in moving)
        if is_apart and abs(other.at(axis) - at) <= near:
            yield f"{moved.written(axis)} == {other.written(axis)}"
            break
    if (origin := _origin(model.root, structure.path)) is not None:
        yield f"{moved.written(axis)} == {fixed(at - origin['xy'.index(axis)], _DECIMALS)}"


def _things(structure: SolvedStructure) -> Iterator[_Thing]:
    """Yields the contents of a structure under the names its constraints use, large things first."""
    inside = f"{structure.path}."
    for below in structure.walk():
        if below is not structure and below.box is not None:
            yield _Thing(below.path.removeprefix(inside), below.box, is_point=False)
    for geometry in structure.walk_geometry():
        yield from _placed(geometry, inside)


def _placed(geometry: SolvedGeometry, inside: str) -> Iterator[_Thing]:
    name = geometry.path.removeprefix(inside)
    if not _WRITABLE.fullmatch(name):
        return
    if (box := Box.around(geometry.curves(), ())) is not None:
        yield _Thing(name, box, is_point=False)
    for field, value in geometry.values.items():
        match value:
            case (float() as x, float() as y):
                point = name if field == "at" else f"{name}.{field}"
                yield _Thing(point, Box(x, y, x, y), is_point=True)


def _origin(root: SolvedStructure, path: str) -> Vec | None:
    """Returns the origin of a structure's frame in that of the root; None if it is turned or mirrored."""
    x = y = 0.0
    for outer in root.walk():
        if outer is not root and f"{path}.".startswith(f"{outer.path}."):
            if outer.frame.mirrored or abs(outer.frame.rotation) > _ALIGNED:
                return None
            x, y = x + outer.frame.x, y + outer.frame.y
    return x, y


def _number_of(structure: SolvedStructure, name: str) -> float | None:
    thing, _, field = name.rpartition(".")
    path = f"{structure.path}.{thing}" if thing else structure.path
    values: list[object] = [s.params.get(field) for s in structure.walk() if s.path == path]
    values += [g.values.get(field) for g in structure.walk_geometry() if g.path == path]
    return next((float(v) for v in values if isinstance(v, float | int) and not isinstance(v, bool)), None)
