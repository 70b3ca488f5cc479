"""Copies of geometry and structures, derived for good: other coordinates over the same unknowns."""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING

from aidl_lang.building import expression as ex
from aidl_lang.building.model import Frame, Geometry, Structure
from aidl_lang.building.motion import STILL, Motion, opposite
from aidl_lang.building.outlines import keep_unnamed
from aidl_lang.building.primitives import DIRECTIONS, clockwise, translate
from aidl_lang.building.scopes import Binding, CopiedBinding, LetBinding, Scope
from aidl_lang.building.state import Interpreter
from aidl_lang.building.values import Array, ListVal, Num, Pattern, PointVal, RecordVal
from aidl_lang.checking.builtins import EVERYWHERE
from aidl_lang.common.records import record
from aidl_lang.common.source import Span

if TYPE_CHECKING:
    from aidl_lang.building.values import Value

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
        if source.recipe is not None:
            copy.recipe = source.recipe.made_of(self.geometry, lambda n: self._number("", n, source.owner))
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
        is_turned = self._swaps_sides and names.values.keys() >= _SIDES
        for name, binding in names.values.items():
            new = self._renamed(name, names)
            if name == "angle" and is_turned and isinstance(binding, Num):
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
        return self.owner is not None and self.motion.mirrored and self.motion.cos.value > 1e-9

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
        """Returns the counterpart of a value of the source in the copy. `name`: angles that are directions
        turn.
        """
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
            seen = translate("", p, owner, self.owner)
            assert isinstance(seen, PointVal)
            p = seen
        return p if self.motion is STILL else self.motion.point(p)

    def _number(self, name: str, value: Num, owner: Structure) -> Num:
        if self.motion is STILL:
            return value
        if name in DIRECTIONS:
            if self.owner is not None:
                seen = translate(name, value, owner, self.owner)
                assert isinstance(seen, Num)
                value = seen
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
        """Returns the copy of a structure with all it holds except its constraints: they are about the
        unknowns, which are the source's.
        """
        self.it.count_entity(self.span)
        copy = Structure(source.kind, name, parent, self.span or source.span, frame)
        copy.source, copy.doc = source, source.doc
        copy.attributes = dict(source.attributes)
        parent.children.append(copy)
        self.structures[source] = copy
        if source.plan is not None:
            x, y, width, height = source.plan
            grown = (ex.mul(self.motion.scale, e) for e in (width, height))
            copy.plan = (*self.motion.place(x, y), *grown)  # type: ignore[assignment]
        for child in source.children:
            self.structure(child, copy, child.name, self._inner(child.frame))
        self._members(source, copy)
        for child in source.children:
            if child.clip and all(g.owner is source for g in child.clip):
                self.structures[child].clip = tuple(self.geometry(g) for g in child.clip)
            if child.ground is source:
                self.structures[child].ground = copy
        copy.is_complete = source.is_complete
        return copy

    def _inner(self, frame: Frame) -> Frame:
        x, y = self.motion.place(frame.x, frame.y)
        return Frame(x, y, frame.rotation, frame.mirrored)

    def _members(self, source: Structure, copy: Structure) -> None:
        from aidl_lang.building.structures import own_names  # they instantiate what is copied

        names = source.scope
        assert isinstance(names, Scope)
        copy.scope = scope = Scope(_around(names.parent, source, copy), copy, labels=names.labels)
        own_names(scope, copy)
        for name, binding in names.values.items():
            if name not in EVERYWHERE:
                scope.values[name] = self._binding(name, binding, source, scope)
        copy.members = {name: self.value(name, v, source) for name, v in source.members.items()}
        copy.geometry = {name: self.value(name, v, source) for name, v in source.geometry.items()}

    def _binding(self, name: str, binding: Binding, source: Structure, scope: Scope) -> Binding:
        """Returns a name's binding in the copy: a `let` reads the members of the copy; values that are no
        geometry are the source's own.
        """
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
