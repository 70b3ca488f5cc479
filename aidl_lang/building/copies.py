"""Copies of geometry and structures, derived for good: other coordinates over the same unknowns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace

from aidl_lang.building import curves
from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, spelled_out
from aidl_lang.building.coerce import as_written
from aidl_lang.building.curves import (
    DIRECTIONS,
    NOWHERE,
    STILL,
    Motion,
    after,
    clockwise,
    mirrored_at_line,
    mirrored_at_point,
    opposite,
    translate,
    translation,
    turned,
    view,
    xy,
)
from aidl_lang.building.expression import Place
from aidl_lang.building.members import read
from aidl_lang.building.model import Frame, Geometry, Structure, convert, reach_of
from aidl_lang.building.outlines import keep_unnamed
from aidl_lang.building.state import (
    Arguments,
    CopiedBinding,
    Env,
    Function,
    Interpreter,
    LetBinding,
    NameBinding,
    Scope,
    own_names,
)
from aidl_lang.building.values import (
    NOTHING,
    Array,
    Instantiation,
    ListVal,
    Nothing,
    Num,
    Pattern,
    PointVal,
    RecordVal,
    StructureCopy,
    TextVal,
    Value,
    certain,
    kind_of,
    leaves,
    members,
    number,
    point,
)
from aidl_lang.checking.builtins import EVERYWHERE
from aidl_lang.checking.units import LENGTH
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_OPPOSITE = {"left": "right", "right": "left", "top": "bottom", "bottom": "top"}
_SIDES = frozenset(_OPPOSITE)


@record(frozen=False, eq=False)
class Copier:
    """The copies that belong together: whatever their sources share, they share too.

    owner       the structure that gets copied geometry; None while a structure is copied as a whole, whose
                contents are in the frame of their own copy what they are in that of the source
    motion      in the frame of the owner; of a structure's contents, their scale
    reach       an ancestor of the owner whose unknowns the copies depend on
    """

    it: Interpreter
    owner: Structure | None
    motion: Motion
    reach: Structure | None = None
    span: Span | None = None
    made: dict[Geometry, Geometry] = field(default_factory=dict)
    structures: dict[Structure, Structure] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.it.copiers.append(self)

    # --- Geometry ------------------------------------------------------------------------------

    def geometry(self, source: Geometry) -> Geometry:
        if (known := self.made.get(source)) is not None:
            return known
        self.it.count_entity(self.span)
        is_turned_over = self.motion.mirrored
        if self.owner is not None:
            is_turned_over = clockwise(source, self.owner) != is_turned_over
        else:
            is_turned_over = source.clockwise
        copy = replace(
            source,
            owner=self.owner or self.structures[source.owner],
            span=self.span or source.span,
            fields={},
            parts={},
            scope=None,
            clockwise=is_turned_over,
            name=None,
            container=None,
            source=source,
            known_as=None,
            reach=self.reach or source.reach,
            finishes={},
            views={},
            turns={},
        )
        self.made[source] = copy
        if copy.reach is not None:
            self.it.following.append(copy)
        if source.name is None and source.known_as is None:
            source.known_as = copy
        self._place(source, copy)
        copy.fields = {name: self.value(name, v, source.owner) for name, v in source.fields.items()}
        if isinstance(source.scope, Scope):
            self._contents(source, source.scope, copy)
        if source.recipe is not None:
            copy.recipe = source.recipe.made_of(self._operand, lambda n: self._number("", n, source.owner))
            keep_unnamed(copy)
        return copy

    def _operand(self, source: Geometry) -> Geometry:
        """Returns an operand of a copied outline; a copied structure does not move geometry outside of it."""
        return self.geometry(source) if self.owner or source.owner in self.structures else source

    def _place(self, source: Geometry, copy: Geometry) -> None:
        """Puts a part into the copy of what its source is part of; a copy standing alone waits for a name."""
        if isinstance(source.container, Geometry) and source.container in self.made:
            names = source.container.scope
            copy.container = self.made[source.container]
            copy.name = self._renamed(source.name or "", names) if isinstance(names, Scope) else source.name
        elif isinstance(source.container, Structure) and source.container in self.structures:
            copy.container, copy.name = self.structures[source.container], source.name

    def _contents(self, source: Geometry, names: Scope, copy: Geometry) -> None:
        copy.scope = scope = Scope(names.parent, copy)
        for name, binding in names.values.items():
            new = self._renamed(name, names)
            has_sides = names.values.keys() >= _SIDES
            if name == "angle" and self._swaps_sides and has_sides and isinstance(binding, Num):
                # With left and right exchanged, the direction from left to right stays.
                turned = self._number(name, binding, source.owner)
                scope.values[new] = replace(turned, expression=opposite(turned.expression))
            elif isinstance(binding, Geometry | Array | ListVal | RecordVal | PointVal | Num):
                scope.values[new] = self.value(name, binding, source.owner)
            else:
                scope.values[new] = CopiedBinding(name, binding, source, self.value)
        copy.parts = {
            self._renamed(name, names): self.value(name, part, source.owner)
            for name, part in source.parts.items()
        }

    # --- Names that say a side -----------------------------------------------------------------

    @property
    def _swaps_sides(self) -> bool:
        """True if left becomes right; otherwise a reflection exchanges top and bottom."""
        return self.owner is not None and self.motion.mirrored and self.motion.facing.x.value > 1e-9

    def _renamed(self, name: str, names: Scope) -> str:
        """Returns the name of a part after a reflection: the part called left is on the left again."""
        if self.owner is None or not self.motion.mirrored:
            return name
        sides = ("left", "right") if self._swaps_sides else ("top", "bottom")
        stem, bracket, index = name.partition("[")
        words = [_OPPOSITE[w] if w in sides else w for w in stem.split("_")]
        new = "_".join(words)
        return new + bracket + index if new in names.values else name

    # --- Values --------------------------------------------------------------------------------

    def value(self, name: str, value: Value, owner: Structure) -> Value:
        """Returns the counterpart of a value of the source in the copy. `name`: directions turn."""
        match value:
            case Geometry():
                return self._operand(value)
            case Structure():
                return self.structures.get(value, value)
            case Array():
                return self._array(name, value, owner)
            case ListVal(items):
                return ListVal(tuple(self.value(name, item, owner) for item in items))
            case RecordVal(fields):
                return RecordVal({key: self.value(key, item, owner) for key, item in fields.items()})
            case PointVal():
                return self._point(value, owner)
            case Num():
                return self._number(name, value, owner)
            case _:
                return value

    def _array(self, name: str, source: Array, owner: Structure) -> Array:
        copy = Array(source.name)
        if isinstance(source, Pattern):
            copy = Pattern(source.name, self.geometry(source.settings))
        copy.members = {index: self.value(name, item, owner) for index, item in source.members.items()}
        return copy

    def _point(self, p: PointVal, owner: Structure) -> PointVal:
        if self.owner is not None:
            p = certain(translate("", p, owner, self.owner), PointVal)
        return p if self.motion is STILL else self.motion.point(p)

    def _number(self, name: str, value: Num, owner: Structure) -> Num:
        if self.motion is STILL:
            return value
        if name in DIRECTIONS:
            if self.owner is not None:
                value = certain(translate(name, value, owner, self.owner), Num)
            return replace(value, expression=self.motion.direction(value.expression))
        return replace(value, expression=self.motion.measure(value.expression, value.dimension))

    # --- Outlines around structures ------------------------------------------------------------

    def clip(self) -> None:
        """Gives copies of structures the outlines that their sources are clipped to, when these are known;
        one outside of the source lies to the copy as it lies to the source, and a solid outside where it is.
        """
        for source, copy in tuple(self.structures.items()):
            if copy in self.it.clips:
                continue
            if source.ground is not None:
                copy.ground = self.structures.get(source.ground, source.ground)
            if source.clip:
                seen = Copier(self.it, source, STILL, span=self.span)
                copy.clip = tuple(
                    self.geometry(g if g.owner in self.structures else seen.geometry(g)) for g in source.clip
                )

    # --- Finishes ------------------------------------------------------------------------------

    def finish(self) -> None:
        """Gives the copies the fillets and chamfers of their sources, when all of these are known."""
        runs: dict[int, int] = {}
        for source in dict.fromkeys([*self.structures, *(g.owner for g in self.made)]):
            for finish in tuple(source.finishes):
                of = tuple(self.made[g] for g in finish.of if g in self.made)
                owner = of[0].owner if of else self.structures.get(source)
                if owner is None or len(of) < len(finish.of):
                    continue
                at = self._point(finish.at, source) if finish.at is not None else None
                sizes = tuple(self._number("", size, source) for size in finish.sizes)
                if finish.run not in runs:
                    self.it.runs += 1
                    runs[finish.run] = self.it.runs
                owner.finishes.append(replace(finish, of=of, at=at, sizes=sizes, run=runs[finish.run]))
        for g, copy in self.made.items():
            copy.finishes |= {name: self._number("", n, g.owner) for name, n in g.finishes.items()}

    # --- Structures ----------------------------------------------------------------------------

    def structure(self, source: Structure, parent: Structure, name: str, frame: Frame) -> Structure:
        """Returns the copy of a structure without its constraints, which are about the source's unknowns."""
        self.it.count_entity(self.span)
        copy = Structure(source.kind, name, parent, self.span or source.span, frame)
        copy.source, copy.doc = source, source.doc
        copy.attributes = dict(source.attributes)
        parent.children.append(copy)
        self.structures[source] = copy
        if source.plan is not None:
            x, y, width, height = source.plan
            x, y = self.motion.place(Place(x, y))
            copy.plan = x, y, self.motion.scale * width, self.motion.scale * height
        for child in source.children:
            frame = child.frame
            inner = Frame(*self.motion.place(frame.origin), frame.rotation, frame.mirrored)
            self.structure(child, copy, child.name, inner)
        self._members(source, copy)
        for child in source.children:
            if child.clip and all(g.owner is source for g in child.clip):
                self.structures[child].clip = tuple(self.geometry(g) for g in child.clip)
            if child.ground is source:
                self.structures[child].ground = copy
        copy.is_complete = source.is_complete
        return copy

    def _members(self, source: Structure, copy: Structure) -> None:
        names = certain(source.scope, Scope)
        copy.scope = scope = Scope(_around(names.parent, source, copy), copy, labels=names.labels)
        own_names(scope, copy)
        for name, binding in names.values.items():
            if name not in EVERYWHERE:
                scope.values[name] = self._binding(name, binding, source, scope)
        copy.members = {name: self.value(name, v, source) for name, v in source.members.items()}
        copy.geometry = {name: self.value(name, v, source) for name, v in source.geometry.items()}

    def _binding(self, name: str, binding: NameBinding, source: Structure, scope: Scope) -> NameBinding:
        """Returns a name's binding in the copy, whose members a `let` reads; the rest is the source's."""
        if isinstance(binding, LetBinding):
            return LetBinding(binding.node, scope)
        if isinstance(binding, Geometry | Structure | Array | ListVal | RecordVal | PointVal):
            return self.value(name, binding, source)
        return binding


def _around(scope: Scope | None, source: Structure, copy: Structure) -> Scope:
    """Returns the scope around the source's body, with the source's own name for the copy."""
    around = Scope(scope.parent if scope else None)
    if scope is not None:
        around.callables, around.aliases = scope.callables, scope.aliases
        around.values = {n: copy if v is source else v for n, v in scope.values.items()}
    return around


# --- `mirror`, `copy`, `move`, `rotate` and `scale` as expressions: a new thing, derived for good.
#
# They are built in because a copy of a shape has all its parts and names, whatever shape it is, and a copy
# of a structure all it holds: no definition of the language can say that.

_AXES: Mapping[str, tuple[float, float]] = {
    "x": (1.0, 0.0),
    "horizontal": (1.0, 0.0),
    "y": (0.0, 1.0),
    "vertical": (0.0, 1.0),
}


_NONE = number(0.0, LENGTH)


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
            return StructureCopy(source, after(first, copier.motion), node)
        case Instantiation():
            return StructureCopy(value, copier.motion, node)
        case ListVal() | Array():
            items = [_copied(it, item, copier, node, env) for item in members(value) or ()]
            return NOTHING if any(isinstance(i, Nothing) for i in items) else ListVal(tuple(items))
        case _:
            message = f"`{node.callee.text}` copies geometry and structures, and this is {kind_of(value)}"
            hint = "name the thing itself, a list of things, or a call that makes one"
            return it.report("E0331", message, node, hints=[hint])


def _of_structure(it: Interpreter, source: Structure, motion: Motion, node: ast.Call, env: Env) -> Value:
    here = env.here
    if here.is_within(source):
        hint = "copy it in the structure around it"
        return it.report("E0331", f"`{source.name}` would hold a copy of itself", node, hints=[hint])
    if not source.is_within(here):
        message = f"`{source.path}` is copied in a structure that does not hold it"
        hint = f"copy it in `{source.parent.path}`" if source.parent else "copy a structure of this one"
        return it.report("E0331", message, node, hints=[hint])
    return StructureCopy(source, motion, node)


def _geometry_in(value: Value) -> list[Geometry]:
    return [item for item in leaves(value) if isinstance(item, Geometry)]


def centre_of(it: Interpreter, value: Value, node: ast.Node, env: Env) -> Place:
    """Returns where a thing turns and grows about: its centre, a structure's origin, or its box's middle."""
    here = env.here
    match value:
        case PointVal():
            return xy(value)
        case Structure():
            return convert(NOWHERE, value, here)
        case StructureCopy(source, motion):
            return motion.place(convert(NOWHERE, source, here) if isinstance(source, Structure) else NOWHERE)
        case Geometry():
            if (known := _own_centre(it, value, node, here)) is not None:
                return xy(known)
    if (box := box_of(value, here)) is None:
        return NOWHERE
    return Place(*spelled_out(*certain(box.field("center"), PointVal).place))


def _own_centre(it: Interpreter, g: Geometry, node: ast.Node, here: Structure) -> PointVal | None:
    found: Value | None
    if isinstance(g.scope, Scope):
        binding = g.scope.values.get("center")
        found = read(it, binding, node, Env(g.scope, g.owner)) if binding is not None else None
        if isinstance(found, Geometry):
            return _own_centre(it, found, node, here)
        found = translate("center", found, g.owner, here) if isinstance(found, PointVal) else None
    else:
        found = curves.field(g, "center", here)
    return found if isinstance(found, PointVal) else None


def _mirror(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    motion = _reflection(it, a["about"], node, env)
    return copied(it, a["x"], motion, node, env) if motion is not None else NOTHING


def _reflection(it: Interpreter, about: Value, node: ast.Call, env: Env) -> Motion | None:
    match about:
        case TextVal(word) if word in _AXES:
            x, y = _AXES[word]
            return mirrored_at_line(point(*NOWHERE), point(ex.constant(x), ex.constant(y)))
        case PointVal():
            return mirrored_at_point(xy(about))
        case Geometry(type="point"):
            return mirrored_at_point(xy(view(about, env.here)["at"]))
        case Geometry(type="line"):
            ends: Iterable[Value] = (view(about, env.here)[name] for name in ("start", "end"))
            if about.name is None and about.span is not None and about.span.overlaps(node.span):
                ends = map(as_written, ends)  # written in the call, it is nothing to move
            start, end = (certain(each, PointVal) for each in ends)
            if start.place.written != end.place.written:
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
        to = to + xy(a["by"])
    if (motion := _motion(it, a.get("angle"), a.get("scale"), about, to, node)) is None:
        return NOTHING
    copied_things = _geometry_in(a["x"])
    is_loose = any(g.name is None for g in copied_things) or isinstance(a["x"], Instantiation)
    # A part of an imported drawing is taken to another structure to be what that one is.
    drawn = [g for g in copied_things if not g.is_guide and (g.trace is None or g.owner is env.here)]
    is_seen = bool(drawn) or not copied_things
    # In a loop a copy that is given a motion may lie still in one turn only.
    never_moves = not env.scope.labels or a.keys() == {"x"}
    if motion.is_still and is_seen and not is_loose and never_moves:
        where = "say where it goes: `by: (10, 0)`, `center: p` or `angle: 90deg`"
        stays = "it stays so: a constraint on it is one on what it is a copy of"
        it.report("W0510", "this copy lies exactly on what it is a copy of", node, hints=[where, stays])
    return copied(it, a["x"], motion, node, env)


def _changed(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    motion = motion_for(it, a, lambda: centre_of(it, a["x"], node, env), node)
    return copied(it, a["x"], motion, node, env) if motion is not None else NOTHING


def motion_for(it: Interpreter, a: Arguments, centre: Callable[[], Place], node: ast.Call) -> Motion | None:
    """Returns the motion of `move`, `rotate` or `scale` for its arguments; `centre` is where the thing is."""
    if "by" in a:
        return translation(xy(a["by"]))
    if "dx" in a or "dy" in a:
        return translation(Place(*(certain(a.get(name, _NONE), Num).expression for name in ("dx", "dy"))))
    about = xy(a["about"]) if "about" in a else centre()
    return _motion(it, a.get("angle"), a.get("factor"), about, about, node)


def _motion(
    it: Interpreter, angle: Value | None, scale: Value | None, about: Place, to: Place, node: ast.Call
) -> Motion | None:
    motion = turned(angle.expression, about, to) if isinstance(angle, Num) else Motion(about, to)
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
