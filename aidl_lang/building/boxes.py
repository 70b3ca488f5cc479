"""Boxes: the extent of structures, geometry and lists of them in the frame of the structure that asks.

A box contains a structure's own curves (tight, construction geometry aside) and its child structures' boxes,
holes excepted. Its sides are spelled out only when the comparison they stand in is known, because a box that
meets the box of one of its descendants there leaves that descendant out (paper, appendix B).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from aidl_lang.building import curves
from aidl_lang.building import expression as ex
from aidl_lang.building.curves import defining, towards, view, xy
from aidl_lang.building.expression import Expression, Place, Unknown
from aidl_lang.building.model import Geometry, Measurement, Recipe, Structure, chain, convert
from aidl_lang.building.values import Num, PointVal, Value, certain, leaves, length, point
from aidl_lang.checking.types import BoxType
from aidl_lang.common.records import record

SIDES = ("left", "right", "top", "bottom")
CORNERS = ("top_left", "top_right", "bottom_left", "bottom_right")
MIDDLES = ("top_center", "bottom_center", "left_center", "right_center")

FIELDS = (*SIDES, "width", "height", "center", "center_x", "center_y", *CORNERS, *MIDDLES)

Source = Geometry | Structure | PointVal


@record(eq=False)
class Box:
    """The common box of its sources, as `here` sees them."""

    value_type = BoxType()

    sources: tuple[Source, ...]
    here: Structure

    def side(self, name: str) -> Expression:
        """Returns left, right, top or bottom; spelled out at once if no structure is in the box."""
        side = Side(self, name)
        if any(isinstance(source, Structure) for source in self.sources):
            return ex.lazy(side)
        return extent(side, frozenset())

    def field(self, name: str) -> Num | PointVal:
        """Returns one of `FIELDS`."""
        low, high = ("left", "right") if name in ("width", "center_x") else ("bottom", "top")
        match name:
            case "left" | "right" | "top" | "bottom":
                return length(self.side(name))
            case "width" | "height":
                return length(self.side(high) - self.side(low))
            case "center_x" | "center_y":
                return length((self.side(low) + self.side(high)) * 0.5)
            case "center":
                return self._at("center", "center")
            case _:
                a, b = name.split("_")
                return self._at(a, b) if a in ("top", "bottom") else self._at(b, a)

    def _at(self, vertical: str, horizontal: str) -> PointVal:
        x = self.field("center_x" if horizontal == "center" else horizontal)
        y = self.field("center_y" if vertical == "center" else vertical)
        return point(certain(x, Num).expression, certain(y, Num).expression)


@record(frozen=False, eq=False)
class Side:
    """A side of a box that is not yet spelled out."""

    box: Box
    name: str

    @property
    def value(self) -> float:
        return self.spelled_out.value

    @cached_property
    def spelled_out(self) -> Expression:
        return extent(self, frozenset())

    def unknowns(self) -> Iterator[Unknown]:
        for source in self.box.sources:
            yield from source_unknowns(source, self.box.here)


def source_unknowns(source: object, here: Structure) -> Iterator[Unknown]:
    """Yields the unknowns that place a source: its own, and the frames between it and `here`."""
    if isinstance(source, PointVal):
        yield from ex.unknowns([source.x.expression, source.y.expression])
    elif isinstance(source, Geometry):
        yield from ex.unknowns(defining(source, here))
    elif isinstance(source, Structure):
        for frame in (s.frame for s in chain(source, here)):
            yield from ex.unknowns([frame.x, frame.y, frame.rotation])
        yield from _interior(source)


def _interior(structure: Structure) -> Iterable[Unknown]:
    """Returns the unknowns that place the contents of a structure, each in its own frame."""
    if structure.interior is not None:
        return structure.interior
    found = dict.fromkeys(
        u
        for inner in structure.walk()
        for u in ex.unknowns([*(inner.plan or ()), *(e for g in inner.own() for e in defining(g, inner))])
    )
    if structure.is_complete:
        structure.interior = tuple(found)
    return found


def boxes_in(*roots: Expression) -> tuple[Mapping[Structure, frozenset[str]], frozenset[Unknown] | None]:
    """Returns the structures whose boxes some expressions mention, each with the sides of it, and the
    unknowns that they mention beside these; None for the latter if they mention no structure's box.
    """
    if not any(root.is_open for root in roots):
        return {}, None
    leaves = [node for node in ex.nodes(roots) if not node.args]
    sides = [node.payload for node in leaves if isinstance(node.payload, Side)]
    found: dict[Structure, frozenset[str]] = {}
    for side in sides:
        for source in side.box.sources:
            if isinstance(source, Structure):
                found[source] = found.get(source, frozenset()) | {side.name}
    if not found:
        return {}, None
    beside = {node.payload for node in leaves if isinstance(node.payload, Unknown)}
    for side in sides:
        others = (s for s in side.box.sources if not isinstance(s, Structure))
        beside.update(u for source in others for u in source_unknowns(source, side.box.here))
    return found, frozenset(beside)


def spelled_out(*roots: Expression, equal: bool = False) -> tuple[Expression, ...]:
    """Returns the expressions of one comparison with every side of a box spelled out. If they are the same
    sides of an assembly of parts and of one of these, and shall be `equal`, that part is the outermost: it is
    not left out.
    """
    if not any(root.is_open for root in roots):
        return roots
    order = list(ex.nodes(roots, only_open=True))
    sides = [n.payload for n in order if isinstance(n.payload, Side)]
    if not sides:
        return roots
    flush = equal and len({root.payload.name for root in roots if isinstance(root.payload, Side)}) == 1
    flush = flush and all(isinstance(root.payload, Side) for root in roots)
    used = {s for side in sides for s in side.box.sources if isinstance(s, Structure)}

    def known(side: object) -> Expression | None:
        if not isinstance(side, Side):
            return None
        tops = [s for s in side.box.sources if isinstance(s, Structure)]
        ignored = (
            u for u in used for t in tops if u is not t and u.is_within(t) and (t.geometry or not flush)
        )
        return extent(side, frozenset(ignored))

    return _replaced(order, known, roots)


def _replaced(
    order: Iterable[Expression], known: Callable[[object], Expression | None], roots: tuple[Expression, ...]
) -> tuple[Expression, ...]:
    """Returns expressions with the nodes of whose payload something is known replaced by that."""
    replaced: dict[Expression, Expression] = {}
    for node in order:
        if node.payload is not None and (found := known(node.payload)) is not None:
            replaced[node] = found
        elif any(a in replaced for a in node.args):
            replaced[node] = ex.apply(node.op, *[replaced.get(a, a) for a in node.args])
    return tuple(replaced.get(root, root) for root in roots)


def extent(side: Side, ignored: frozenset[Structure]) -> Expression:
    """Returns a side as the extreme of everything in the box; 0 if there is nothing in it."""
    here, name = side.box.here, side.name
    only = side.box.sources[0] if len(side.box.sources) == 1 else None
    whole = only if isinstance(only, Structure) and only.is_complete else None
    key = (here, name, ignored)
    if whole is not None and key in whole.extents:
        return whole.extents[key]
    candidates = list(dict.fromkeys(e for s in side.box.sources for e in _extremes(s, here, name, ignored)))
    found = _extreme_of(candidates, name)
    if whole is not None:
        whole.extents[key] = found
    return found


def _extreme_of(candidates: list[Expression], side: str) -> Expression:
    if not candidates:
        return ex.ZERO
    return candidates[0] if len(candidates) == 1 else ex.apply(towards(side).further, *candidates)


def _extremes(
    source: Source, here: Structure, side: str, ignored: frozenset[Structure]
) -> Iterator[Expression]:
    if isinstance(source, PointVal):
        yield xy(source)[towards(side).axis]
    elif isinstance(source, Geometry):
        if source.type == "point":
            yield xy(view(source, here)["at"])[towards(side).axis]
        else:
            for primitive in source.primitives(even_construction=True):
                yield from _curve(primitive, here, side)
    elif source not in ignored:
        yield from _structure(source, source, here, side, ignored)


def _structure(
    source: Structure, whole: Structure, here: Structure, side: str, ignored: frozenset[Structure]
) -> Iterator[Expression]:
    """Yields candidates for the extreme of a structure within the `whole` that has the box."""
    if source.plan:
        left, bottom, width, height = source.plan
        right, top = left + width, bottom + height
        for corner in ((left, bottom), (right, bottom), (left, top), (right, top)):
            yield convert(Place(*corner), source, here)[towards(side).axis]
    for primitive in source.drawn():
        if not _lies_inside(primitive, whole, ignored):
            yield from _curve(primitive, here, side)
    for child in source.children:
        clips = child.clip
        is_clipped = child.ground is source or (bool(clips) and all(_is_in(g, whole, ignored) for g in clips))
        if child.kind != "hole" and child not in ignored and not is_clipped:
            yield from _structure(child, whole, here, side, ignored)


def _lies_inside(outline: Geometry, whole: Structure, ignored: frozenset[Structure]) -> bool:
    """Tells whether an outline made of others is a part of one in the same box, as a pattern is of the wall
    that it fills: it takes no room of its own then.
    """
    if (recipe := outline.recipe) is None:
        return False
    covers: Sequence[tuple[Geometry, ...]] = ()
    match recipe.kind:
        case "tiled":
            covers = recipe.operands[1:2]
        case "clip" | "intersect":
            covers = recipe.operands
        case "difference":
            covers = recipe.operands[:1]
        case "offset" if recipe.numbers["distance"].value <= 0:
            covers = recipe.operands
    inside = whole, ignored
    return any(all(_is_in(g, *inside) or _lies_inside(g, *inside) for g in cover) for cover in covers)


def _is_in(g: Geometry, whole: Structure, ignored: frozenset[Structure]) -> bool:
    """Tells whether a geometry is drawn in the box of a structure."""
    here = None if g.is_guide else g.owner
    while here is not None and here is not whole and here.kind != "hole" and here not in ignored:
        here = here.parent
    return here is whole


def _curve(primitive: Geometry, here: Structure, side: str) -> Iterable[Expression]:
    if primitive.recipe is not None and primitive.is_drawn_later:
        return _made(primitive, primitive.recipe, here, side)
    return curves.reach(primitive, here, side)


_AS_WIDE = frozenset({"hull", "union", "shell"})  # outlines whose box is the box of their sources


def _made(outline: Geometry, recipe: Recipe, here: Structure, side: str) -> Iterator[Expression]:
    """Yields, for an outline made of others, their extremes, or these moved out by the radius of a disc
    around them; any other has a box only once it is drawn. A pattern has that of what it fills.
    """
    grown: Expression | None = None
    sources = recipe.sources
    match recipe.kind:
        case "tiled":
            grown, sources = ex.ZERO, recipe.operands[1]
        case kind if kind in _AS_WIDE:
            grown = ex.ZERO
        case "thick" if recipe.words["caps"] == recipe.words["joins"] == "round":
            grown = recipe.numbers["width"].expression * 0.5
        case "offset" if (
            recipe.words["corners"] == "round" and (out := recipe.numbers["distance"]).value >= 0
        ):
            grown = out.expression
    if grown is None:
        yield ex.measure(Measurement(side, (outline,), here))
        return
    for source in sources:
        for extreme in _extremes(source, here, side, frozenset()):
            yield towards(side).outwards(extreme, grown)


def foreseen(*roots: Expression) -> tuple[Expression, ...]:
    """Returns expressions with each side of a box that only the drawing has replaced by what it will be in
    most cases: what is cut keeps its box, a part in common has the common part of the boxes, and what is
    moved in or out has its sides moved as far.
    """
    return with_measured(_foreseen_side, *roots)


def with_measured(
    known: Callable[[Measurement], Expression | None], *roots: Expression
) -> tuple[Expression, ...]:
    """Returns expressions with what the drawing would be measured for replaced by what is known of it."""

    def found(payload: object) -> Expression | None:
        return known(payload) if isinstance(payload, Measurement) else None

    return _replaced(list(ex.nodes(roots, only_open=True)), found, roots)


def _made_of(side: Measurement) -> tuple[Recipe, Structure]:
    """Returns the recipe of the outline whose side is measured, and the structure that sees it."""
    outline, here = side.of[0], side.here
    assert isinstance(outline, Geometry)
    assert outline.recipe is not None
    assert here is not None
    return outline.recipe, here


def _foreseen_side(measured: Measurement) -> Expression:
    side, (recipe, here) = measured.kind, _made_of(measured)
    _, outwards, further = towards(side)
    reached = (
        (e for g in operand for e in _extremes(g, here, side, frozenset())) for operand in recipe.operands
    )
    extents = foreseen(*[_extreme_of(list(dict.fromkeys(each)), side) for each in reached])
    match recipe.kind:
        case "clip" | "intersect":
            return ex.apply("minimum" if further == "maximum" else "maximum", *extents)
        case "offset":
            out = recipe.numbers["distance"].expression
        case "thick":
            out = recipe.numbers["width"].expression * 0.5
        case _:
            return extents[0]
    return outwards(extents[0], out)


def constrain_sources(outline: Geometry, here: Structure) -> str:
    """Returns the hint that names what an outline is made of, to be constrained in its place."""
    assert outline.recipe is not None
    source = outline.recipe.sources[0]
    known_as = source.name if source.owner is outline.owner else source.path.removeprefix(f"{here.path}.")
    if source.container is outline and outline.name is not None:
        known_as = source.path.removeprefix(f"{here.path}.")
    hint = f"constrain what it is made of: `{known_as or source.type}`"
    if outline.recipe.kind == "difference":
        hint += ", or cut with a `hole`, which leaves the box as it is"
    return hint


def unmoved(*roots: Expression) -> frozenset[Unknown]:
    """Returns the unknowns that place what outlines, whose boxes only the drawing has, are clipped by or cut
    with: a constraint on such an outline does not move these.
    """
    held: set[Unknown] = set()
    for node in ex.nodes(roots, only_open=True):
        if isinstance(node.payload, Measurement):
            recipe, here = _made_of(node.payload)
            first, *others = (
                {u for g in operand for u in source_unknowns(g, here)} for operand in recipe.operands
            )
            held |= set().union(*others) - first
    return frozenset(held)


def box_of(value: Value, here: Structure) -> Box | None:
    """Returns the box of a value; None if it has none."""
    if isinstance(value, Box):
        return value
    sources = tuple(_sources(value))
    return Box(sources, here) if sources else None


def _sources(value: Value) -> Iterable[Source]:
    for item in leaves(value):
        if isinstance(item, Box):
            yield from item.sources
        elif isinstance(item, Geometry | Structure | PointVal):
            yield item
