"""The looks that attributes ask for, and the order of drawing."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from graphlib import TopologicalSorter
from typing import TypeAlias

from aidl_lang.building.attributes import FILLING, OF_AREAS
from aidl_lang.checking.builtins import BEHIND, IN_FRONT, STACKING
from aidl_lang.common.colors import css_color
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.names import fold
from aidl_lang.common.prose import named, ticked
from aidl_lang.common.records import record
from aidl_lang.geometry.notes import united_notes
from aidl_lang.geometry.solved import Frame, Scalar, SolvedGeometry, SolvedStructure

# --- The looks that attributes ask for: colours, lines, how much shows through. They hold for all inside.

Attributes: TypeAlias = Mapping[str, tuple[Scalar, ...]]

DASH, GAP = 0.012, 0.008
"""Dashes without lengths of their own and the gaps between them, relative to the larger side of a drawing."""
_OF_BODIES = ("color", "stroke", "dash", "opacity", "shade", "shadow", "halo", "quantity")
"""Looks and numbers that a body has as a whole."""


@record()
class Shade:
    """How the fill of a body changes over it: as on a `round` bar, a `ball` or a `slope`, to nothing, or to
    another colour; and the way it goes in the frame of the root, in degrees; None for out of the middle.
    """

    kind: str
    way: float | None


@record()
class Turn:
    """The directions of a structure in the root's frame: its x axis, degrees, and -1 where mirrored."""

    first: float = 0.0
    sense: float = 1.0

    def within(self, frame: Frame) -> Turn:
        """Returns the turn of a structure with that frame in this one."""
        own = frame.rotation + (180.0 if frame.mirrored else 0.0)
        return Turn(self.first + self.sense * own, -self.sense if frame.mirrored else self.sense)

    @property
    def own(self) -> float:
        """How far the structure is turned, from 0 up to 360, whether or not it is mirrored first."""
        return (self.first if self.sense > 0 else self.first + 180.0) % 360.0

    def of(self, angle: float) -> float:
        """Returns the direction of an angle of the structure, from -180 up to 180."""
        return (self.first + self.sense * angle + 180.0) % 360.0 - 180.0


@record()
class Style:
    """The looks that the attributes of a structure, or of the nearest one around it that has them, ask
    for.

    stroke   width of its lines, mm; 0 for solids without outline, whose drawings have lines as ever
    dash     lengths of dashes and gaps by turns, mm; none if they go by the size of the drawing
    opacity  how much of what lies behind is covered, from 0 to 1
    shade    how the fill of a body changes over it
    shadow   how far that of the structure falls to the right and up, mm, and a share of black
    halo     width of the clear gap around what lies in front, mm; drawings have one of their own alone
    edges    `seams` if the borders between the geometries of a solid are drawn
    turn     the directions of the structure
    depth    of a hole that ends in its solid, mm, and the angle of a cone, degrees; none if it goes through
    quantity  how many pieces are made of each part, those around it multiplied
    """

    color: str | None = None
    layer: str | None = None
    material: str | None = None
    thickness: float | None = None
    stroke: float | None = None
    dash: tuple[float, ...] | None = None
    opacity: float | None = None
    shade: Shade | None = None
    edges: str | None = None
    halo: float | None = None
    shadow: tuple[float, ...] = ()
    depth: tuple[float, ...] = ()
    quantity: int = 1
    turn: Turn = Turn()

    @property
    def is_clear(self) -> bool:
        """True if what lies behind shows through."""
        fades = self.shade is not None and self.shade.kind == "fade"
        return fades or (self.opacity is not None and self.opacity < 1)

    @property
    def width(self) -> float | None:
        """The width of its strokes, mm; None if they go by the size of the drawing."""
        return self.stroke or None

    @property
    def has_seams(self) -> bool:
        """True if the borders between geometries that are united are drawn."""
        return self.edges == "seams"

    @property
    def is_unlined(self) -> bool:
        """True if its solids have no outline."""
        return self.stroke == 0

    @property
    def is_blind(self) -> bool:
        """True for holes that end in their solid, and for cones, which are wide at its face alone."""
        is_deep = self.thickness is not None and self.depth[:1] >= (self.thickness,)
        return bool(self.depth) and not (is_deep and len(self.depth) == 1)

    @property
    def is_area(self) -> bool:
        """True if drawings are engraved as areas: on a layer of that name."""
        return self.layer is not None and fold(self.layer) == "fill"

    def dashes(self, size: float) -> tuple[float, ...] | None:
        """Returns dashes and gaps by turns, mm, in a drawing of a size; None for whole lines."""
        return (DASH * size, GAP * size) if self.dash == () else self.dash


def styles_of(root: SolvedStructure) -> dict[str, Style]:
    """Returns the style of each structure by its path."""
    styles: dict[str, Style] = {}

    def visit(structure: SolvedStructure, around: Style, kind: str, turn: Turn) -> None:
        if structure.kind == "drawing" != kind:
            # A gap around bodies is none around all that is drawn on them.
            around = replace(around, halo=None)
        style = _within(replace(around, turn=turn), structure.attributes)
        styles[structure.path] = style
        for child in structure.structures:
            visit(child, style, structure.kind, turn.within(child.frame))

    visit(root, Style(), "", Turn())
    return styles


def styled(style: Style, geometry: SolvedGeometry) -> Style:
    """Returns the style of a geometry in a structure of a style: that one, but for attributes of its own."""
    return _within(style, geometry.attributes)


def is_filled(geometry: SolvedGeometry, within: str) -> bool:
    """Tells whether geometry is an area with a look of its own; with a width, in a drawing it is a line."""
    stated = geometry.attributes
    if within != "drawing":
        return not stated.keys().isdisjoint((*FILLING, "stroke"))
    is_line = not {"dash", "stroke"}.isdisjoint(stated) and not is_unlined(stated)
    return not stated.keys().isdisjoint(FILLING) and not is_line


def is_inlay(s: SolvedStructure) -> bool:
    """Tells whether a solid has a look of its own, which in another solid makes an area of it."""
    return s.kind == "solid" and not s.attributes.keys().isdisjoint(FILLING)


def united_parts(body: SolvedStructure) -> Iterator[SolvedStructure]:
    """Yields the structures that are one body: of a solid all material in it, of another structure itself."""
    inner = body.walk() if body.kind == "solid" else (body,)
    return (s for s in inner if s is body or s.kind not in ("hole", "drawing"))


def veils(
    root: SolvedStructure, styles: Mapping[str, Style], *, is_inner: bool = False
) -> Iterator[tuple[str, Sequence[str], bool]]:
    """Yields for each body its path, the paths of its veils, and whether it is bare. Veils are translucent
    and fading areas that add no material: they lie on what else the body has. A body of nothing else is
    made of them. A body is bare if it is all areas and shows what is behind: they have no colour below them.
    """
    if root.kind == "solid" and not is_inner:
        parts = [root]
        for part in parts:
            parts += [child for child in part.structures if child.kind == "solid"]
        drawn = [g for part in parts for g in part.drawn if not g.construction]
        areas = [g for g in drawn if is_filled(g, "solid")]
        seen = [g.path for g in areas if styled(Style(), g).is_clear]
        is_bare = len(areas) == len(drawn) > 0
        is_made = is_bare and len(seen) == len(drawn)
        yield root.path, () if is_made else seen, is_made or (is_bare and styles[root.path].is_clear)
    for child in root.structures:
        yield from veils(child, styles, is_inner=root.kind == child.kind == "solid")


def is_unlined(stated: Attributes) -> bool:
    """Tells whether attributes ask for solids and areas without outline."""
    return stated.get("stroke") == ("none",)


def _within(around: Style, stated: Attributes) -> Style:
    shade = around.shade
    if "shade" in stated:
        shade = _shade(stated["shade"], around.turn)
    elif shade is not None and "color" in stated and css_color([shade.kind]):
        shade = None  # The colour that went over into another is not this one.
    return Style(
        css_color(stated.get("color", ())) or around.color,
        _text(stated.get("layer")) or around.layer,
        _text(stated.get("material")) or around.material,
        _number(stated.get("thickness"), around.thickness),
        0.0 if is_unlined(stated) else _number(stated.get("stroke"), around.stroke),
        _dash(stated["dash"]) if "dash" in stated else around.dash,
        _number(stated.get("opacity"), around.opacity),
        shade,
        _text(stated.get("edges")) or around.edges,
        _number(stated.get("halo"), around.halo),
        _numbers(stated.get("shadow", ())),
        _numbers(stated.get("depth", ())),
        around.quantity * int(_number(stated.get("quantity"), 1.0) or 1),
        around.turn,
    )


_DOWN = -90.0
_LIT = ("round", "slope")
"""Shades that light makes: it comes from the left and from above, however a part is turned."""


def _shade(values: Sequence[Scalar], turn: Turn) -> Shade | None:
    kind, *angles = values
    if kind == "none":
        return None
    if kind == "fade" and not angles:
        return Shade("fade", None)
    angle = angles[0] if angles else 0.0 if kind == "round" else _DOWN
    assert isinstance(angle, int | float)
    way = turn.of(float(angle))
    is_upwards = way > 90.0 - _LEVEL or way <= -90.0 - _LEVEL
    return Shade(str(kind), way + 180.0 if kind in _LIT and is_upwards else way)


_LEVEL = 1e-6


def _text(values: tuple[Scalar, ...] | None) -> str | None:
    return str(values[0]) if values else None


def _number(values: tuple[Scalar, ...] | None, default: float | None) -> float | None:
    first = values[0] if values else None
    return float(first) if isinstance(first, int | float) and not isinstance(first, bool) else default


def _numbers(values: Iterable[Scalar]) -> tuple[float, ...]:
    return tuple(float(v) for v in values if isinstance(v, int | float))


def _dash(values: Iterable[Scalar]) -> tuple[float, ...] | None:
    """Returns the lengths by turns; a single one is that of the gaps, too."""
    stated = tuple(values)
    if stated in ((True,), (False,)) and isinstance(stated[0], bool):
        return () if stated[0] else None
    lengths = _numbers(stated)
    return lengths * 2 if len(lengths) == 1 else lengths


def idle_areas(root: SolvedStructure, areas: Collection[str], loose: Collection[str]) -> list[Diagnostic]:
    """Returns warnings about looks of geometry that encloses nothing of its body, but what is `loose`."""
    lined = [(s, g) for s in root.walk() if s.kind == "drawing" for g in s.drawn if g.path not in areas]
    mixed = {s.path for s in root.walk() for g in s.drawn if g.path in areas}
    unlined = {h.path: h for pair in lined for h in pair if is_unlined(h.attributes) and h.path not in mixed}
    hints = ("give a width, as in `@stroke(0.3mm)`; a closed geometry with a `@color` is an area",)
    message = "`@stroke(none)` of `{}` counts for nothing where lines are drawn: they have a width"
    return [Diagnostic("W0727", message.format(p), h.span, hints=hints) for p, h in unlined.items()] + [
        Diagnostic(
            "W0727",
            f"{' and '.join(ticked([w for w in FILLING if w in g.attributes], '@'))} of `{g.path}` "
            f"counts for nothing: it encloses no part of `{s.path}`, or is covered by what is written later",
            g.span,
            hints=("put it where there is material, or into a `drawing`",),
        )
        for s in root.walk()
        for g in s.drawn
        if not g.construction
        if s.kind not in ("drawing", "hole") and is_filled(g, s.kind) and g.path not in areas
        if not any(part.path in loose for part in g.walk())
    ]


def idle_looks(
    root: SolvedStructure, bodies: Collection[str], styles: Mapping[str, Style]
) -> list[Diagnostic]:
    """Returns warnings about looks that a part of a body cannot have by itself."""

    def other(s: SolvedStructure, body: SolvedStructure) -> list[str]:
        own, whole = styles[s.path], styles[body.path]
        words = [w for w in _OF_BODIES if w in s.attributes and getattr(own, w) != getattr(whole, w)]
        drawn = [below for below in s.walk() if below.geometry]
        if s.kind == "solid" and any(below.kind == "solid" for below in drawn):
            has_areas = is_inlay(s) or any(is_filled(g, "solid") for below in drawn for g in below.drawn)
            return [w for w in words if not (has_areas and w in OF_AREAS)]
        if "color" in words and any(below.kind == "drawing" for below in drawn):
            words.remove("color")  # the drawing takes it
        return words

    return united_notes(root, bodies, other)


# --- The order of drawing: that of writing, but for what `@behind` and `@in_front` say.

_REMEDY = "make `{0}` an `assembly` of several bodies"


def stacked(root: SolvedStructure) -> Iterator[SolvedStructure]:
    """Yields a structure and all below it from back to front; parts lie on the whole."""
    return (s for s, _, is_more in layers(root) if not is_more)


def layers(root: SolvedStructure) -> Iterator[tuple[SolvedStructure, Sequence[SolvedGeometry], bool]]:
    """Yields a structure and all below it from back to front, each with its geometry; and once more, marked
    by True, with what is written behind a drawing in it, or a solid in a solid, and so lies over that.
    """
    kinds = {"solid": ("drawing", "solid"), "drawing": ()}.get(root.kind, ("drawing",))
    last = {s.span: s for s in root.structures if s.kind in kinds}  # of each statement
    inner = list(reversed(last.values()))
    laid: dict[str, list[SolvedGeometry]] = {root.path: []}
    for g in root.drawn:
        below = next((s for s in inner if _is_before(s, g)), root)
        laid.setdefault(below.path, []).append(g)
    yield root, laid[root.path], False
    for child in _ordered(root.structures):
        yield from layers(child)
        if child.path in laid:
            yield root, laid[child.path], True


def _is_before(s: SolvedStructure, g: SolvedGeometry) -> bool:
    a, b = s.span, g.span
    return a is not None and b is not None and a.source is b.source and a.start < b.start


def places_of(root: SolvedStructure) -> dict[str, int]:
    """Returns the places of structures and geometry in the order of drawing, by their paths."""
    paths = dict.fromkeys(path for s, laid, _ in layers(root) for path in (s.path, *(g.path for g in laid)))
    return {path: place for place, path in enumerate(paths)}


def idle_orders(root: SolvedStructure, bodies: Collection[str]) -> list[Diagnostic]:
    """Returns warnings about orders between structures that are not drawn by themselves: parts of a body."""

    def other(s: SolvedStructure, body: SolvedStructure) -> list[str]:
        return [name for name in STACKING if name in s.attributes]

    found = united_notes(root, bodies, other, hint=_REMEDY)
    for around in root.walk():
        parts = {s.name for s in around.structures if s.kind != "drawing" and s.path not in bodies}
        for s in around.structures if around.kind == "solid" else ():
            for name in STACKING if s.kind == "drawing" else ():
                united = [part for part in map(str, s.attributes.get(name, ())) if part in parts]
                what = f"{named(united, 3)} {'is' if len(united) == 1 else 'are'}"
                message = f"`@{name}` of `{s.path}` counts for nothing: {what} one body with `{around.path}`"
                hints = (_REMEDY.format(around.name),)
                if united:
                    found.append(
                        Diagnostic("W0727", message, s.span, "drawn on all of that body", hints=hints)
                    )
    return found


def _ordered(beside: Sequence[SolvedStructure]) -> Sequence[SolvedStructure]:
    """Returns structures side by side from back to front.

    Who states an order that writing does not give stands directly behind, or in front of, what it names; the
    others keep their order.
    """
    if not any(name in s.attributes for s in beside for name in STACKING):
        return beside
    places = {s.name: number for number, s in enumerate(beside)}
    said = {
        (s.name, name): [other for other in map(str, s.attributes.get(name, ())) if other in places]
        for s in beside
        for name in STACKING
    }
    wanted = _wanted(places, said)
    order: TopologicalSorter[str] = TopologicalSorter(dict.fromkeys(places, ()))
    for (own, name), others in said.items():
        for other in others:
            order.add(*((other, own) if name == BEHIND else (own, other)))
    order.prepare()
    found, ready = [], list[str]()
    while order.is_active():
        ready = sorted((*ready, *order.get_ready()), key=lambda name: (wanted[name], places[name]))
        found.append(beside[places[ready[0]]])
        order.done(ready.pop(0))
    return found


def _wanted(places: dict[str, int], said: dict[tuple[str, str], list[str]]) -> dict[str, float]:
    """Returns the place each structure asks for: its own, or a little beside that of what it names."""
    wanted: dict[str, float] = {name: float(place) for name, place in places.items()}
    step = 1 / (len(places) + 1)
    for _ in places:
        before = dict(wanted)
        for (own, name), others in said.items():
            if others and name == BEHIND:
                wanted[own] = min(wanted[own], min(wanted[other] for other in others) - step)
            elif others and name == IN_FRONT:
                wanted[own] = max(wanted[own], max(wanted[other] for other in others) + step)
        if wanted == before:
            break
    return wanted
