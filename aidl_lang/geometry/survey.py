"""The measures of a solved drawing, of the whole and of its parts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import combinations

from aidl_lang.building.curves import gauss
from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.materials import density, similar
from aidl_lang.common.names import find, nearest
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.boolean import Contact, region_distance
from aidl_lang.geometry.curves import Bezier, Bounds, Line, Piece, Vec
from aidl_lang.geometry.drawing import Body, Drawing, region_alone
from aidl_lang.geometry.region import Region, measure
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.geometry.walls import widths

# --- Second moments of area of a region, from its exact pieces.
#
# They are integrals along the outline: of straight lines in closed form, of all others by Gauss-Legendre
# quadrature. With twelve nodes it is exact for Bézier curves (whose integrand is a polynomial of degree 11)
# and exact to rounding for a quarter of a circle or an ellipse; the closed form of an arc would lose all
# digits where the arc is shallow and its radius large.

_ISOTROPIC = 1e-9
"""Difference of the principal moments, relative to them, below which every axis is a principal one."""
_ROUNDING = 1e-12
"""Part of the moments below which the product of inertia counts as zero."""

Squares = tuple[float, float, float]
"""Integrals of x², y² and xy over an area."""


@record(slots=True)
class Inertia:
    """Second moments of area about the centroid, mm⁴: xx = ∫y² dA, yy = ∫x² dA, xy = ∫xy dA."""

    xx: float
    yy: float
    xy: float

    @property
    def polar(self) -> float:
        """About the axis that stands on the plane."""
        return self.xx + self.yy

    @property
    def principal(self) -> tuple[float, float]:
        """The largest and the least about any axis in the plane."""
        middle, half = self.polar / 2, math.hypot((self.xx - self.yy) / 2, self.xy)
        return middle + half, middle - half

    @property
    def angle(self) -> float:
        """The angle to the axis of the largest moment, degrees over -90 to 90; 0 if all are equal."""
        largest, least = self.principal
        if largest - least <= _ISOTROPIC * largest:
            return 0.0
        if abs(self.xy) <= _ROUNDING * largest:
            return 0.0 if self.xx > self.yy else 90.0
        return math.degrees(math.atan2(-2 * self.xy, self.xx - self.yy)) / 2


def inertia(region: Region, centroid: Vec) -> Inertia:
    """Returns the second moments of a region about its centroid."""
    xx = yy = xy = 0.0
    for loop in region.loops:
        sign = -1 if loop.reversed else 1
        start, (a, mx, my) = loop.start, loop.moments
        dx, dy = start[0] - centroid[0], start[1] - centroid[1]
        sx, sy, sxy = map(math.fsum, zip(*(_piece_squares(p, start) for p in loop.pieces), strict=True))
        # The parallel axis theorem, from the start of the loop to the centroid.
        xx += sign * sx + 2 * dx * mx + dx * dx * a
        yy += sign * sy + 2 * dy * my + dy * dy * a
        xy += sign * sxy + dx * my + dy * mx + dx * dy * a
    return Inertia(yy, xx, xy)


def _piece_squares(piece: Piece, origin: Vec) -> Squares:
    """Returns the second moments of the triangle fan from the origin to the piece: integrals of (p × p')
    times a quarter of x², y² and xy.
    """
    if isinstance(piece, Line):
        px, py, qx, qy = (end[k] - origin[k] for end in piece.ends for k in (0, 1))
        a = (px * qy - py * qx) / 12
        return (
            a * (px * px + px * qx + qx * qx),
            a * (py * py + py * qy + qy * qy),
            a * (px * py + (px * qy + qx * py) / 2 + qx * qy),
        )
    spans = 1
    if not isinstance(piece, Bezier):
        spans = max(1, math.ceil(abs(piece.range[1]) / (math.pi / 2) - 1e-9))
    xx = yy = xy = 0.0
    for k in range(spans):
        for node, weight in gauss(12):
            t = (k + node) / spans
            x, y = piece.point(t)
            x, y = x - origin[0], y - origin[1]
            dx, dy = piece.derivative(t)
            cross = weight / spans * (x * dy - y * dx) / 4
            xx, yy, xy = xx + cross * x * x, yy + cross * y * y, xy + cross * x * y
    return xx, yy, xy


# --- The measures of a solved drawing: areas, inertia, thin places and masses of the whole and of its parts,
# and the contacts between bodies. Lengths in mm, volumes in mm³, masses in g, coordinates in the root's
# frame.

ALL_PAIRS = 100
"""The most bodies of which all pairs are compared."""
_NAMED = 6
"""Paths that a list names."""


@record()
class Width:
    """A wall or a gap: its length, its two ends, and the part that it is in."""

    length: float
    a: Vec
    b: Vec
    part: str

    def to_dict(self) -> dict[str, object]:
        """Returns the form in JSON."""
        return {"length": self.length, "from": self.a, "to": self.b, "part": self.part}


@record()
class Part:
    """The measures of one thing.

    kind       `body`; `bodies` for what holds several; `solid` for one that is united with what is around it;
               `hole`; `geometry` for an outline as a solid of its own
    pieces, holes   connected areas, and holes in them
    bodies     how many there are in it; 0 for what is no body
    wall, gap  the thinnest wall and the narrowest gap (see `geometry.walls`); of several bodies the least
    quantity   how many pieces are made of a body, of which the measures tell one
    volume, mass    None where a thickness or a density is not known; of several bodies the sum, with all
               the pieces that are made of each
    """

    path: str
    kind: str
    area: float
    perimeter: float
    centroid: Vec
    inertia: Inertia
    box: Bounds
    pieces: int
    holes: int
    bodies: int = 0
    wall: Width | None = None
    gap: Width | None = None
    material: str | None = None
    density: float | None = None
    thickness: float | None = None
    volume: float | None = None
    mass: float | None = None
    quantity: int = 1

    def to_dict(self) -> dict[str, object]:
        """Returns the form in JSON."""
        left, bottom, right, top = self.box
        return {
            **_read(self, "path", "kind", "bodies", "area", "perimeter", "centroid"),
            "box": {"left": left, "right": right, "top": top, "bottom": bottom},
            "width": right - left,
            "height": top - bottom,
            **_read(self, "pieces", "holes"),
            "inertia": _read(self.inertia, "xx", "yy", "xy", "polar", "principal", "angle"),
            "wall": self.wall and self.wall.to_dict(),
            "gap": self.gap and self.gap.to_dict(),
            **_read(self, "thickness", "material", "density", "volume", "mass", "quantity"),
        }


def _read(of: Part | Inertia, *names: str) -> dict[str, object]:
    return {name: getattr(of, name) for name in names}


@record()
class Survey:
    """The whole, the parts asked for or else all bodies, and the pairs of bodies, overlaps first, then by
    gap. `alone` are the bodies that touch no other; `is_partial` says that far pairs are not listed.
    """

    whole: Part
    parts: tuple[Part, ...]
    pairs: tuple[Contact, ...]
    alone: tuple[str, ...]
    is_partial: bool
    notes: tuple[Diagnostic, ...]


class NothingThereError(AidlError, KeyError):
    """Nothing to measure at a path: `known` are the paths there are, `near` those perhaps meant."""

    def __init__(self, path: str, reason: str, near: Sequence[str], known: Sequence[str]) -> None:
        what = f"`{path}` {reason}" if reason else f"there is no `{path}` in the drawing"
        hints = did_you_mean(near)
        if known:
            hints.append(f"there is {some_of(known)}")
        super().__init__(Diagnostic("E0919", what, hints=tuple(hints)))
        self.near = tuple(near)

    __str__ = ValueError.__str__  # a KeyError's shows the path alone, in quotes


def some_of(names: Sequence[str]) -> str:
    """Returns the first names as a sentence has them, and the number of the others."""
    return first_few(ticked(names), _NAMED)


def survey(
    model: SolvedModel,
    drawing: Drawing,
    paths: Sequence[str] = (),
    own_densities: Mapping[str, float] | None = None,
) -> Survey:
    """Measures the whole, and the parts at some paths or else each body.

    Raises NothingThereError for a path at which nothing covers an area.
    """
    surveyor = _Surveyor(model, drawing, own_densities or {})
    parts = [surveyor.part(path) for path in paths]
    whole = surveyor.of_bodies(model.root.path, drawing.bodies)
    if not paths:
        parts = [surveyor.body(b) for b in drawing.bodies]
    names = [b.path for b in drawing.bodies]
    pairs = (*drawing.pairs, *(_far_pairs(drawing) if len(names) <= ALL_PAIRS else ()))
    held = {path for pair in pairs if pair.relation != "apart" for path in (pair.a, pair.b)}
    return Survey(
        whole,
        tuple(parts),
        tuple(sorted(pairs, key=lambda pair: (pair.gap or 0.0, -(pair.area or 0.0)))),
        tuple(path for path in names if path not in held) if len(names) > 1 else (),
        len(pairs) < len(names) * (len(names) - 1) // 2,
        tuple(surveyor.notes()),
    )


def _far_pairs(drawing: Drawing) -> Iterator[Contact]:
    """Yields the pairs of bodies that the drawing leaves out because their boxes are far from each other."""
    compared = {(pair.a, pair.b) for pair in drawing.pairs}
    for one, other in combinations(drawing.bodies, 2):
        if (one.path, other.path) not in compared:
            closest = region_distance(one.region, other.region)
            yield Contact(one.path, other.path, "apart", gap=closest[0] if closest else None)


def measured(
    model: SolvedModel,
    drawing: Drawing,
    path: str | None = None,
    own_densities: Mapping[str, float] | None = None,
) -> Part:
    """Returns the part at a path, or the whole. Raises NothingThereError as `survey` does."""
    surveyor = _Surveyor(model, drawing, own_densities or {})
    return surveyor.part(path) if path else surveyor.of_bodies(model.root.path, drawing.bodies)


@record(frozen=False)
class _Surveyor:
    """Measures parts of a drawing, each body once."""

    model: SolvedModel
    drawing: Drawing
    own_densities: Mapping[str, float]
    _bodies: dict[str, Part] = field(default_factory=dict)
    _unknown: dict[str, str] = field(default_factory=dict)

    def part(self, written: str) -> Part:
        """Returns the part at a path, written with or without the name of the root."""
        path, kind = self._find(written)
        if kind == "geometry":
            region = region_alone(self.model.root, path)
            if not region:
                raise self._missing(written, "encloses no area: its curves do not close")
            return _measured(path, kind, region)
        inside = [b for b in self.drawing.bodies if b.path == path or b.path.startswith(f"{path}.")]
        if len(inside) == 1 and inside[0].path == path:
            return self.body(inside[0])
        if inside and (len(inside) > 1 or path not in self.drawing.regions):
            return self.of_bodies(path, inside)
        region = self.drawing.regions.get(path, Region())
        if not region:
            raise self._missing(
                written, f"is {'an' if kind[0] in 'aeiou' else 'a'} {kind} that covers no area"
            )
        return _measured(path, kind, region)

    def body(self, body: Body) -> Part:
        if body.path not in self._bodies:
            self._bodies[body.path] = self._with_mass(_measured(body.path, "body", body.region), body)
        return self._bodies[body.path]

    def of_bodies(self, path: str, bodies: Sequence[Body]) -> Part:
        """Returns several bodies as one part; where they overlap, both count."""
        if len(bodies) == 1 and bodies[0].path == path:
            return self.body(bodies[0])
        parts = [self.body(b) for b in bodies]
        together = _part(path, "bodies", Region(tuple(face for b in bodies for face in b.region.faces)))
        return replace(
            together,
            bodies=len(bodies),
            box=together.box if bodies else self.drawing.box,
            wall=min((p.wall for p in parts if p.wall), key=lambda w: w.length, default=None),
            gap=min((p.gap for p in parts if p.gap), key=lambda w: w.length, default=None),
            volume=_total([p.volume and p.volume * p.quantity for p in parts]),
            mass=_total([p.mass and p.mass * p.quantity for p in parts]),
        )

    def _with_mass(self, part: Part, body: Body) -> Part:
        thickness, material = body.style.thickness, body.style.material
        volume = None if thickness is None else part.area * thickness
        known = None if material is None else density(material, self.own_densities)
        if material is not None and known is None and volume is not None:
            self._unknown.setdefault(material, part.path)
        mass = None if volume is None or known is None else volume * known * 1e-6  # kg/m³ is 1e-6 g/mm³
        return replace(
            part,
            bodies=1,
            material=material,
            density=known,
            thickness=thickness,
            volume=volume,
            mass=mass,
            quantity=body.style.quantity,
        )

    def notes(self) -> Iterator[Diagnostic]:
        """Yields a note on each material whose density is not known."""
        for material, path in self._unknown.items():
            near = similar(material)
            structure = self.model.root.find(path)
            yield Diagnostic(
                "N0731",
                f"the density of `{material}` is not known, so `{path}` has no mass",
                structure.span if structure else None,
                "made of it",
                hints=(*did_you_mean(near), f'say it in kg/m³: `--density "{material}=1200"`'),
            )

    def _find(self, written: str) -> tuple[str, str]:
        known = self._known()
        root = self.model.root.path
        for path in (written, f"{root}.{written}"):
            if (found := find(path, known)) is not None:
                return found, known[found]
        raise self._missing(written, "")

    def _known(self) -> dict[str, str]:
        structures = list(self.model.root.walk())
        known = {g.path: "geometry" for s in structures for top in s.drawn for g in top.walk()}
        return known | {s.path: s.kind for s in structures}

    def _missing(self, written: str, reason: str) -> NothingThereError:
        known = self._known()
        root = f"{self.model.root.path}."
        names = {name: path for path in known for name in (path.rpartition(".")[2], path.removeprefix(root))}
        near = [] if reason else [names.get(name, name) for name in nearest(written, [*known, *names], 3)]
        covering = [b.path for b in self.drawing.bodies]
        covering += [path for path, region in self.drawing.regions.items() if region]
        return NothingThereError(written, reason, list(dict.fromkeys(near)), list(dict.fromkeys(covering)))


def _total(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) if known and len(known) == len(values) else None


def _measured(path: str, kind: str, region: Region) -> Part:
    checkpoint()
    wall, gap = (Width(c.length, c.a, c.b, path) if c else None for c in widths(region))
    return replace(_part(path, kind, region), wall=wall, gap=gap)


def _part(path: str, kind: str, region: Region) -> Part:
    of, faces = measure(region), len(region.faces)
    squares = inertia(region, of.centroid)
    return Part(path, kind, of.area, of.perimeter, of.centroid, squares, of.box, faces, of.loops - faces)
