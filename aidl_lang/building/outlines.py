"""Outlines made of others, and the finishing of corners: recorded here, carried out after solving."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import spelled_out
from aidl_lang.building.coerce import as_written, may_read, owners_of
from aidl_lang.building.construct import size
from aidl_lang.building.expression import Place
from aidl_lang.building.model import (
    SIZES,
    Finish,
    Frame,
    Geometry,
    Recipe,
    Structure,
    convert_point,
    reach_of,
)
from aidl_lang.building.state import Arguments, Candidate, Env, Function, Interpreter
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Num,
    PointVal,
    TextVal,
    Value,
    kind_of,
    leaves,
    length,
    members,
    point,
)
from aidl_lang.checking.builtins import FINISHES, OUTLINES
from aidl_lang.checking.units import LENGTH
from aidl_lang.common.names import find, fold
from aidl_lang.common.prose import ticked
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

CORNER_WORDS: Mapping[str, tuple[str, ...]] = {
    "corners": ("sharp", "round"),
    "joins": ("round", "sharp"),
    "caps": ("round", "butt", "square"),
    "start": ("here", "center", "corner"),
    "radius": ("max",),
    "size": ("max",),
    "distance": ("max",),
}
"""The words that choose how an outline is made; the first is the default."""
_SYNONYMS = dict.fromkeys(("miter", "mitre", "mitred"), "sharp")
_SYNONYMS |= {"rounded": "round", "flat": "butt", "maximum": "max"}


def _outline(kind: str, *words: str) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        geometry = Geometry(kind, env.here, it.place(node))
        operands: list[tuple[Geometry, ...]] = []
        for value in _operands(kind, a):
            if (group := _sources(it, kind, value, node, env)) is None:
                return NOTHING
            operands.append(tuple(group))
        if kind == "tiled":
            operands.append(_lattice(it, a, node, env))
        said = {name: _word(it, name, a.get(name), node) for name in words}
        if None in said.values():
            return NOTHING
        if len(operands) < 2 and kind in ("union", "intersect", "difference"):
            word = node.callee.text
            it.report("E0337", f"`{word}` takes two outlines or more", node, hints=[f"as in `{word}(a, b)`"])
            return NOTHING
        if _negative(it, a, node):
            return NOTHING
        it.count_entity(node)
        sizes = {n: v for n, v in a.items() if isinstance(v, Num) and n != "angle"}
        numbers = {n: size(it, v, geometry, n) for n, v in sizes.items()}
        geometry.fields = dict(numbers)
        chosen = {n: w for n, w in said.items() if w} | {n: "yes" for n, v in a.items() if v is True}
        geometry.recipe = Recipe(kind, tuple(operands), numbers, chosen)
        owners = [s.bound_to for s in geometry.recipe.sources]
        owners += [owner for number in numbers.values() for owner in owners_of(number, env.here)]
        geometry.reach = reach_of(owners, env.here)
        if geometry.reach is not None:
            it.following.append(geometry)
        _take_over(geometry, env)
        return geometry

    return function


def _negative(it: Interpreter, a: Arguments, node: ast.Call) -> bool:
    """Reports a negative size; only an offset has a direction. Returns whether there is one."""
    for name, v in a.items():
        is_size = name in SIZES or fold(node.callee.text) == "chamfer"
        if is_size and isinstance(v, Num) and v.expression.is_constant and v.value < 0:
            message = f"the {name} of this `{node.callee.text}` is {v.value:g}, and sizes are never negative"
            it.report("E0515", message, node, hints=[f"write {-v.value:g}"])
            return True
    return False


def _operands(kind: str, a: Arguments) -> list[Value]:
    if kind in ("union", "intersect") or (kind == "difference" and "by" not in a):
        return list(members(a["of"]) or ())
    second = a.get("within" if kind == "tiled" else "by")
    return [a["of"]] if second is None else [a["of"], second]


def _lattice(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> tuple[Geometry, ...]:
    """Returns points that tell how a lattice lies: the origin, a place beside and one above it, the first of
    these turned by the angle, and where the steps lead from the origin. They go along with copies.
    """
    angle = a.get("angle")
    frame = Frame(rotation=angle.expression if isinstance(angle, Num) else ex.ZERO)
    x, y = Place(ex.ONE, ex.ZERO), Place(ex.ZERO, ex.ONE)
    ways = [Place(ex.ZERO, ex.ZERO), x, y, frame.turn(x)]
    for name in ("by", "row"):
        if isinstance(p := a.get(name), PointVal):
            ways.append(frame.turn(p.place))
    return tuple(_as_point(it, point(*way), node, env) for way in ways)


def _as_point(it: Interpreter, p: PointVal, node: ast.Call, env: Env) -> Geometry:
    reach = reach_of(owners_of(p, env.here), env.here)
    return Geometry("point", env.here, it.place(node), {"at": p}, reach=reach)


def _word(it: Interpreter, name: str, value: Value | None, node: ast.Call) -> str | None:
    allowed = CORNER_WORDS[name]
    if value is None:
        return allowed[0]
    written = value.value if isinstance(value, TextVal) else ""
    if (meant := find(_SYNONYMS.get(fold(written), written), dict.fromkeys(allowed))) is None:
        choices = ", ".join(ticked(allowed))
        hint = f"it is one of {choices}" if len(allowed) > 1 else f"it is a length, or {choices}"
        it.report("E0516", f'`{name}: "{written}"` is not known', node, hints=[hint])
    return meant


def _sources(it: Interpreter, kind: str, value: Value, node: ast.Call, env: Env) -> list[Geometry] | None:
    found: list[Geometry] = []
    for item in leaves(value):
        if isinstance(item, PointVal) and kind == "hull":
            item = _as_point(it, item, node, env)
        if not isinstance(item, Geometry) or (item.type == "point" and kind != "hull"):
            hint = "give it a circle, a shape such as `rectangle(…)`, or a list of curves that close"
            if isinstance(item, Structure):
                hint = "name the outline in it, as in `plate.outline`"
            message = f"`{node.callee.text}` takes outlines, and this is {kind_of(item)}"
            it.report("E0337", message, node, hints=[hint])
            return None
        found.append(item)
    if not found:
        it.report("E0337", f"`{node.callee.text}` got no outline", node)
        return None
    return found


_KEPT = {"offset": 0, "tiled": 1}
"""The operands that stay drawn: the source of an offset, and the region that is filled."""


def _take_over(geometry: Geometry, env: Env) -> None:
    """Turns the sources into guides, which are not drawn themselves."""
    assert geometry.recipe is not None
    keep_unnamed(geometry)
    here = env.scope.declaring().container or env.here
    kept = geometry.recipe.operands[_KEPT[geometry.recipe.kind]] if geometry.recipe.kind in _KEPT else ()
    for source in geometry.recipe.sources:
        if source.container is here and source not in kept:
            source.construction = True


def keep_unnamed(geometry: Geometry) -> None:
    """Makes sources without a name parts of the outline."""
    assert geometry.recipe is not None
    unnamed = [s for s in geometry.recipe.sources if s.name is None]
    for number, source in enumerate(unnamed):
        source.name, source.container, source.construction = f"source[{number}]", geometry, True
    if unnamed:
        geometry.parts["source"] = ListVal(tuple(unnamed))


def usable(candidates: list[Candidate], values: Sequence[Value], env: Env) -> list[Candidate]:
    """Returns the overloads of an outline; without those of the library if a source or a size belongs to
    another structure, as they would read its unknowns.
    """
    owners = (o for v in values for o in ((v.owner,) if isinstance(v, Geometry) else owners_of(v, env.here)))
    far = any(owner is not env.here for owner in owners)
    return [c for c in candidates if c.signature.kind is None] if far else candidates


def remember(result: Value, name: str, arguments: Arguments) -> None:
    """Notes the source of an outline that the library makes by an operation: the same geometry draws it."""
    if name not in OUTLINES or not isinstance(result, Geometry) or result.recipe or result.name:
        return
    sources = tuple(v for v in arguments.values() if isinstance(v, Geometry))
    numbers = {n: v for n, v in arguments.items() if isinstance(v, Num)}
    result.recipe = Recipe(name, (sources,), numbers, {"corners": "sharp"})


@record()
class _Target:
    """A corner or (without `at`) a whole outline of a structure.

    of   the geometry that is named; `key` the field of it that is the corner, if it is no point itself
    at   the place, in the frame of the owner
    """

    owner: Structure
    of: tuple[Geometry, ...]
    key: str
    at: PointVal | None
    text: str


def _finish(kind: str) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        given = [x.value for x in node.arguments if x.name is None or fold(x.name.text) == "of"]
        targets = list(_targets(it, a["of"], node.receiver or (given[0] if given else node), env))
        if not targets:
            it.report("E0337", f"`{kind}` got no corner", node)
        found = [t for t in targets if t is not None]
        if not found or len(found) < len(targets) or _negative(it, a, node):
            return NOTHING
        if None in [_word(it, n, v, node) for n, v in a.items() if isinstance(v, TextVal)]:
            return NOTHING
        sizes = _sizes(it, kind, a, found[0])
        it.runs += 1
        for target in found:
            for g in target.of if sizes else ():
                g.finishes[_named(target.key, kind)] = sizes[0]
            top = target.of if target.at is None else tuple(map(_outermost, target.of))
            span = it.place(node) or node.span
            target.owner.finishes.append(Finish(kind, top, target.at, sizes, target.text, span, it.runs))
        return True

    return function


def _named(key: str, kind: str) -> str:
    return f"{key}.{kind}" if key else kind


def _sizes(it: Interpreter, kind: str, a: Arguments, target: _Target) -> tuple[Num, ...]:
    """Returns the sizes (but not `max`) by the table of exactness; a literal one is the first corner's."""
    given = [a[name] for name in ("radius", "size", "distance", "second") if name in a]
    numbers = [replace(v, expression=spelled_out(v.expression)[0]) for v in given if isinstance(v, Num)]
    if target.of:
        names = (_named(target.key, kind), _named(target.key, f"{kind}_second"))
        return tuple(size(it, v, target.of[0], n) for v, n in zip(numbers, names, strict=False))
    # A bare point belongs to no geometry, so its structure keeps the size.
    index = len(target.owner.finishes)
    owner, name = target.owner, f"{kind}[{index}]"

    def held(v: Num) -> Num:
        if v.expression.is_constant and v.status is Exactness.NUMBER:
            return length(it.unknown(v.value, owner, name, dimension=LENGTH, kept=True))
        return v

    return tuple(map(held, numbers))


def _targets(it: Interpreter, value: Value, node: ast.Node, env: Env) -> Iterator[_Target | None]:
    if (items := members(value)) is None:
        yield _target(it, value, node, env, node.span.one_line)
        return
    curves = [item for item in items if isinstance(item, Geometry) and item.type != "point"]
    if len(curves) == len(items) > 0 and all(g.owner is curves[0].owner for g in curves):
        reached = may_read(it, curves[0].owner, node, env)
        yield _Target(curves[0].owner, tuple(curves), "", None, node.span.one_line) if reached else None
        return
    for k, item in enumerate(items):
        inner = node.items[k] if isinstance(node, ast.List) and len(node.items) == len(items) else node
        if members(item) is not None:
            yield from _targets(it, item, inner, env)
        else:
            text = inner.span.one_line if inner is not node else f"{node.span.one_line}[{k}]"
            yield _target(it, item, inner, env, text)


def _target(it: Interpreter, value: Value, node: ast.Node, env: Env, text: str) -> _Target | None:
    if isinstance(value, Geometry):
        if not may_read(it, value.owner, node, env):
            return None
        at = value.fields["at"] if value.type == "point" else None
        assert at is None or isinstance(at, PointVal)
        return _Target(value.owner, (value,), "", at, text)
    if isinstance(value, PointVal):
        base, key = _base(it, node, env)
        if base is None:
            return _Target(env.here, (), "", value, text)
        return _Target(base.owner, (base,), key, convert_point(value, env.here, base.owner), text)
    message = f"`{text}` is {kind_of(value)}, and only corners and outlines are rounded or cut off"
    hint = "name a corner (`plate.top_left`), a list of corners, or the outline itself"
    it.report("E0337", message, node, hints=[hint])
    return None


def _base(it: Interpreter, node: ast.Node, env: Env) -> tuple[Geometry | None, str]:
    """Returns the geometry with a name that a point was named as a field of, and the field."""
    key = node.name.text if isinstance(node, ast.Member) else ""
    while isinstance(node, ast.Index):
        node = node.value
    base = it.evaluate(node.value, env) if isinstance(node, ast.Member) else None
    return (base, key) if isinstance(base, Geometry) else (None, "")


def _outermost(geometry: Geometry) -> Geometry:
    while isinstance(geometry.container, Geometry):
        geometry = geometry.container
    return geometry


def finish_size(it: Interpreter, value: Value, name: str, node: ast.Member, env: Env) -> Value | None:
    """Returns the size of a finish, `plate.top_left.fillet`, by its corner or an outline around it."""
    key, kind = "", find(name, dict.fromkeys(FINISHES))
    if isinstance(value, PointVal):
        value, key = _base(it, node.value, env)  # type: ignore[assignment]
    while kind is not None and isinstance(value, Geometry):
        if (found := value.finishes.get(_named(key, kind))) is not None:
            return found if may_read(it, value.owner, node, env) else as_written(found)
        if any(f.kind == kind and not f.sizes and value in f.of for f in value.owner.finishes):
            message = f"`{node.span.one_line}` is the largest that fits, which only the drawing knows"
            hint = "give it a number to refer to it: of one that is too large the most is told"
            return it.report("E0526", message, node, hints=[hint])
        value, key = value.container, ""  # type: ignore[assignment]
    return None


OPERATIONS: Mapping[str, Function] = {
    "offset": _outline("offset", "corners"),
    "shell": _outline("shell", "corners"),
    "thick": _outline("thick", "caps", "joins"),
    "hull": _outline("hull"),
    "union": _outline("union"),
    "intersect": _outline("intersect"),
    "difference": _outline("difference"),
    "cut": _outline("difference"),
    "clip": _outline("clip"),
    "tiled": _outline("tiled", "start"),
    "fillet": _finish("fillet"),
    "chamfer": _finish("chamfer"),
}
