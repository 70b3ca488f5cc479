"""`mirror`, `copy`, `move`, `rotate` and `scale` as expressions: a new thing, derived for good.

They are built in because a copy of a shape has all its parts and names, whatever shape it is, and a copy of a
structure all it holds: no definition of the language can say that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from aidl_lang.building import curves
from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, spelled_out
from aidl_lang.building.coerce import as_written
from aidl_lang.building.derive import Copier
from aidl_lang.building.members import read
from aidl_lang.building.model import Geometry, Structure, convert, reach_of
from aidl_lang.building.motion import (
    NOWHERE,
    Motion,
    Place,
    after,
    mirrored_at_line,
    mirrored_at_point,
    translation,
    turned,
)
from aidl_lang.building.primitives import translate, view, xy
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Arguments, Env, Function, Interpreter, Reach
from aidl_lang.building.values import (
    NOTHING,
    Array,
    Instantiation,
    ListVal,
    Nothing,
    Num,
    PointVal,
    StructureCopy,
    TextVal,
    Value,
    kind_of,
    members,
    number,
)
from aidl_lang.checking.units import LENGTH
from aidl_lang.syntax import ast

_AXES: Mapping[str, tuple[float, float]] = {
    "x": (1.0, 0.0),
    "horizontal": (1.0, 0.0),
    "y": (0.0, 1.0),
    "vertical": (0.0, 1.0),
}


_NONE = number(0.0, LENGTH)


# --- What is copied --------------------------------------------------------------------------------


def copied(it: Interpreter, value: Value, motion: Motion, node: ast.Call, env: Env) -> Value:
    """Returns the copy of anything that can be copied; NOTHING after an error, reported here."""
    owners = [*(g.bound_to for g in _geometry_in(value)), *(u.owner for u in ex.unknowns(motion.parts))]
    copier = Copier(it, env.here, motion, reach_of(owners, env.here), it.place(node))
    return _copied(it, value, copier, node, env)


def _copied(it: Interpreter, value: Value, copier: Copier, node: ast.Call, env: Env) -> Value:
    match value:
        case Geometry():
            copy = copier.geometry(value)
            copy.construction = False  # the copy of a guide guides only if its own definition says so
            return copy
        case PointVal():
            return copier.motion.point(value)
        case Structure():
            return _of_structure(it, value, copier.motion, node, env)
        case StructureCopy(source, first):
            assert isinstance(first, Motion)
            return StructureCopy(source, after(first, copier.motion), node)
        case Instantiation():
            return StructureCopy(value, copier.motion, node)
        case ListVal() | Array():
            items = [_copied(it, item, copier, node, env) for item in members(value) or ()]
            return NOTHING if any(isinstance(i, Nothing) for i in items) else ListVal(tuple(items))
        case _:
            message = f"`{node.callee.text}` copies geometry and structures, and this is {kind_of(value)}"
            hint = "name the thing itself, a list of things, or a call that makes one"
            it.report("E0331", message, node, hints=[hint])
            return NOTHING


def _of_structure(it: Interpreter, source: Structure, motion: Motion, node: ast.Call, env: Env) -> Value:
    here = env.here
    if here.is_within(source):
        hint = "copy it in the structure around it"
        it.report("E0331", f"`{source.name}` would hold a copy of itself", node, hints=[hint])
        return NOTHING
    if not source.is_within(here):
        message = f"`{source.path}` is copied in a structure that does not hold it"
        hint = f"copy it in `{source.parent.path}`" if source.parent else "copy a structure of this one"
        it.report("E0331", message, node, hints=[hint])
        return NOTHING
    return StructureCopy(source, motion, node)


def _geometry_in(value: Value | None) -> Iterator[Geometry]:
    if isinstance(value, Geometry):
        yield value
    else:
        for item in (members(value) or ()) if value is not None else ():
            yield from _geometry_in(item)


# --- Where a thing is ------------------------------------------------------------------------------


def centre_of(it: Interpreter, value: Value, node: ast.Node, env: Env) -> Place:
    """Returns where a thing turns and grows about: its centre, a structure's origin, or its box's middle."""
    here = env.here
    match value:
        case PointVal():
            return xy(value)
        case Structure():
            return convert(*NOWHERE, value, here)
        case StructureCopy(Structure() as source, Motion() as motion):
            return motion.place(*convert(*NOWHERE, source, here))
        case StructureCopy(_, Motion() as motion):
            return motion.place(*NOWHERE)
        case Geometry():
            if (known := _own_centre(it, value, node, here)) is not None:
                return xy(known)
    box = box_of(value, here)
    if box is None:
        return NOWHERE
    middle = box.field("center")
    assert isinstance(middle, PointVal)
    x, y = spelled_out(*xy(middle))
    return x, y


def _own_centre(it: Interpreter, g: Geometry, node: ast.Node, here: Structure) -> PointVal | None:
    found: Value | None
    if isinstance(g.scope, Scope):
        binding = g.scope.values.get("center")
        found = read(it, binding, node, Env(g.scope, g.owner, Reach.OWN)) if binding is not None else None
        if isinstance(found, Geometry):
            return _own_centre(it, found, node, here)
        found = translate("center", found, g.owner, here) if isinstance(found, PointVal) else None
    else:
        found = curves.field(g, "center", here)
    return found if isinstance(found, PointVal) else None


def _at(x: ex.Expression, y: ex.Expression) -> PointVal:
    return PointVal(Num(x), Num(y))


# --- The functions ---------------------------------------------------------------------------------


def _mirror(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    motion = _reflection(it, a["about"], node, env)
    return copied(it, a["x"], motion, node, env) if motion is not None else NOTHING


def _reflection(it: Interpreter, about: Value, node: ast.Call, env: Env) -> Motion | None:
    match about:
        case TextVal(word) if word in _AXES:
            x, y = _AXES[word]
            return mirrored_at_line(_at(*NOWHERE), _at(ex.constant(x), ex.constant(y)))
        case PointVal():
            return mirrored_at_point(xy(about))
        case Geometry(type="point"):
            return mirrored_at_point(xy(view(about, env.here)["at"]))
        case Geometry(type="line"):
            start, end = (view(about, env.here)[name] for name in ("start", "end"))
            if about.name is None and about.span is not None and about.span.overlaps(node.span):
                start, end = as_written(start), as_written(end)  # written in the call, it is nothing to move
            assert isinstance(start, PointVal)
            assert isinstance(end, PointVal)
            if any(p.value != q.value for p, q in zip(xy(start), xy(end), strict=True)):
                return mirrored_at_line(start, end)
            message, hint = "the line to mirror about has no length", "give its ends different places"
        case TextVal(word):
            message, hint = f'"{word}" is no axis', 'the axes are `"x"` and `"y"`'
        case _:
            message = f"`mirror` is about a line or a point, and this is {kind_of(about)}"
            hint = "name a line, an axis (`y_axis`), or a point such as its centre"
    it.report("E0331", message, node, hints=[hint])
    return None


def _copy(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    if "about" in a:
        about = xy(a["about"])
    else:
        about = NOWHERE if a.keys() <= {"x", "by"} else centre_of(it, a["x"], node, env)
    to = xy(a["center"]) if "center" in a else about
    if "by" in a:
        to = ex.add(to[0], xy(a["by"])[0]), ex.add(to[1], xy(a["by"])[1])
    motion = _motion(it, a.get("angle"), a.get("scale"), about, to, node)
    if motion is None:
        return NOTHING
    is_loose = any(g.name is None for g in _geometry_in(a["x"])) or isinstance(a["x"], Instantiation)
    is_seen = any(_is_seen(g, env.here) for g in _geometry_in(a["x"])) or not list(_geometry_in(a["x"]))
    # In a loop a copy that is given a motion may lie still in one turn only.
    never_moves = not env.scope.labels or a.keys() == {"x"}
    if motion.is_still and is_seen and not is_loose and never_moves:
        it.report(
            "W0510",
            "this copy lies exactly on what it is a copy of",
            node,
            hints=[
                "say where it goes: `by: (10, 0)`, `center: p` or `angle: 90deg`",
                "it stays so: a constraint on it is one on what it is a copy of",
            ],
        )
    return copied(it, a["x"], motion, node, env)


def _is_seen(g: Geometry, here: Structure) -> bool:
    """Tells whether a copy would lie on something that is drawn. A guide is not, and a part of an imported
    drawing is taken to another structure to be what that one is.
    """
    if g.trace is not None and g.owner is not here:
        return False
    holder: Geometry | Structure | None = g
    while isinstance(holder, Geometry):
        if holder.construction:
            return False
        holder = holder.container
    return True


def _changed(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    motion = motion_for(it, a, lambda: centre_of(it, a["x"], node, env), node)
    return copied(it, a["x"], motion, node, env) if motion is not None else NOTHING


def motion_for(it: Interpreter, a: Arguments, centre: Callable[[], Place], node: ast.Call) -> Motion | None:
    """Returns the motion of `move`, `rotate` or `scale` for its arguments; `centre` is where the thing is."""
    if "by" in a:
        return translation(xy(a["by"]))
    if "dx" in a or "dy" in a:
        dx, dy = (a.get(name, _NONE) for name in ("dx", "dy"))
        assert isinstance(dx, Num)
        assert isinstance(dy, Num)
        return translation((dx.expression, dy.expression))
    about = xy(a["about"]) if "about" in a else centre()
    return _motion(it, a.get("angle"), a.get("factor"), about, about, node)


def _motion(
    it: Interpreter, angle: Value | None, scale: Value | None, about: Place, to: Place, node: ast.Call
) -> Motion | None:
    motion = Motion(about, to)
    if isinstance(angle, Num):
        motion = turned(angle.expression, about, to)
    if isinstance(scale, Num):
        if not scale.value > 0:
            hint = "`mirror(x, about: …)` turns a thing over"
            it.report("E0331", f"a scale is more than 0, and this is {scale.value:g}", node, hints=[hint])
            return None
        motion = replace(motion, scale=scale.expression)
    return motion


FUNCTIONS: dict[str, Function] = {
    "mirror": _mirror,
    "copy": _copy,
    "move": _changed,
    "translate": _changed,
    "rotate": _changed,
    "scale": _changed,
}
