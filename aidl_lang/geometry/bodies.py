"""The bodies of the whole, with what they are clipped to and the seams in them."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import count

from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.prose import counted, named
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Arc, Bezier, Line, Piece, Vec, in_runs, larger_side
from aidl_lang.geometry.faces import WINDING, OwnFace, Shape, own_faces, union_of
from aidl_lang.geometry.intersect import near_pairs
from aidl_lang.geometry.network import Network, with_finer_chords
from aidl_lang.geometry.sections import Section, traced, union
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure, at, edges_of

# --- What structures are clipped to, in the network of curves: solids and holes lie inside of it.

Clips = Mapping[str, Shape]
"""By the path of the structure that states it, the outline that one is clipped to."""


def clip_shapes(root: SolvedStructure, first: int) -> tuple[dict[str, Shape], list[Piece]]:
    """Returns what structures are clipped to, with its curves: in the network, those from `first` on."""
    shapes: dict[str, Shape] = {}
    curves: list[Piece] = []
    numbers = count(first)
    for s in root.walk():
        if s.inside is not None:
            whole = SolvedGeometry("clip", f"{s.path}.clip", "clip", {}, None, (), False, s.span)
            leaves = edges_of(whole, s.inside.pieces)
            shapes[s.path] = Shape(whole, tuple(zip(leaves, numbers, strict=False)))
            curves += s.inside.pieces
    return shapes, curves


def clip_sections(
    network: Network, s: SolvedStructure, shapes: Clips, around: Section | None = None
) -> Iterator[tuple[str, Section]]:
    """Yields the paths of a structure and of those in it that are clipped, or lie in one that is (`around`),
    and what each may lie in.

    No closure, which would keep itself and what it holds: Manifold tells of sections left at the end.
    """
    if s.path in shapes:
        around = union_of(own_faces(network, [shapes[s.path]]).faces)
    if around is not None:
        yield s.path, around
    for child in s.structures:
        yield from clip_sections(network, child, shapes, around)


def empty_clips(root: SolvedStructure, drawn: Collection[str]) -> Iterator[Diagnostic]:
    """Yields errors about structures of which nothing is left inside; `drawn`: paths of what is there."""
    if root.inside is None or any(s.path in drawn for s in root.walk()):
        for child in root.structures:
            yield from empty_clips(child, drawn)
    elif any(True for s in root.walk() for g in s.geometry for _ in g.curves()):
        of = named([g.name for g in root.clip]) if root.ground is None else f"the material of `{root.ground}`"
        yield Diagnostic(
            "E0339",
            f"nothing of `{root.path}` lies inside {of}, to which it is clipped",
            root.span,
            "nothing is drawn of this",
            hints=("place the two so that they overlap, as they shall in the drawing",),
        )


# --- Builds the bodies of the whole, bottom-up, from the faces of each structure.
#
# The region of a solid is (own faces + solid children) − holes + islands: a hole cuts all of the structure
# that holds it, a solid inside a hole is an island. An assembly keeps its solid children as separate bodies;
# what it draws itself is one more, and its holes cut them all. Where this leaves a choice:
# - an assembly inside a solid is united with it, all its bodies;
# - a hole inside a hole cuts what that hole cuts, and the islands beside it;
# - solids and holes inside a drawing are treated as in an assembly.

_FEW_HOLES, _FEW_VERTICES = 8, 200
"""Numbers below which each hole is compared with the whole material."""


@record()
class Void:
    """The material that a hole removed."""

    hole: SolvedStructure
    section: Section


@record()
class Mass:
    """A connected or scattered piece of material that belongs to one structure.

    `inner` lists the paths of the structures united in it.
    """

    structure: SolvedStructure
    section: Section
    voids: tuple[Void, ...] = ()
    inner: tuple[str, ...] = ()


@record()
class Cut:
    """The holes that a hole consists of, and the islands that stay in it."""

    holes: tuple[Void, ...]
    islands: tuple[Mass, ...]

    @property
    def section(self) -> Section:
        return union([hole.section for hole in self.holes])


@record()
class LooseCurves:
    """Curves of a structure that bound no face, with their numbers in the network.

    `numbers` are those of all curves of the structure.
    """

    structure: SolvedStructure
    curves: tuple[tuple[SolvedGeometry, int], ...]
    numbers: tuple[int, ...]


@record()
class Covered:
    """A face that adds nothing, because other faces of its structure cover it, or so many `holes` of one."""

    structure: SolvedStructure
    face: OwnFace
    by: tuple[SolvedGeometry, ...]
    holes: int = 0


Finding = Covered | LooseCurves | Diagnostic


@record(frozen=False)
class Bodies:
    """The state of the walk and its result; `sections` has each structure that has material or cuts, `faces`
    what each draws itself, `bodies` what is left of material in the end. `clips`: for each structure that is
    clipped, what it may lie in. `blind`: the holes that end in their solid, which stays whole as seen from
    above.
    """

    network: Network
    shapes: Mapping[str, Sequence[Shape]]
    clips: Mapping[str, Section] = field(default_factory=dict)
    blind: Collection[str] = ()
    sections: dict[str, Section] = field(default_factory=dict)
    faces: dict[str, list[OwnFace]] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    bodies: list[Mass] = field(default_factory=list)

    def masses(self, structure: SolvedStructure) -> list[Mass]:
        """Returns the material of a structure that is not a hole."""
        own = None if structure.kind == "drawing" else self._own(structure)
        children = [m for c in structure.structures if c.kind != "hole" for m in self.masses(c)]
        cuts = [self.cut(c) for c in structure.structures if c.kind == "hole"]
        if structure.kind == "solid":
            return self._united(structure, own, children, cuts)
        return self._separate(structure, own, children, cuts)

    def cut(self, hole: SolvedStructure) -> Cut:
        """Returns the area that a hole and the holes in it take away, and its islands."""
        own = self._own(hole)
        inner = [self.cut(c) for c in hole.structures if c.kind == "hole"]
        islands = [m for c in hole.structures if c.kind != "hole" for m in self.masses(c)]
        taken = union([c.section for c in inner])
        islands = [replace(m, section=m.section - taken) for m in islands]
        islands += [m for c in inner for m in c.islands]
        holes = ([] if own is None else [Void(hole, own)]) + [v for c in inner for v in c.holes]
        if holes:
            self.sections[hole.path] = union([v.section for v in holes])
        if hole.path in self.blind:
            holes = [void for void in holes if void.hole is not hole]
        return Cut(tuple(holes), tuple(islands))

    def _own(self, structure: SolvedStructure) -> Section | None:
        """Returns the area that a structure draws itself; None if it encloses nothing."""
        shapes = self.shapes.get(structure.path, ())
        if not shapes:
            return None
        own = own_faces(self.network, shapes)
        if own.loose:
            numbers = tuple(number for shape in shapes for number in shape.numbers)
            self.findings.append(LooseCurves(structure, tuple(own.loose), numbers))
        self.findings += [crossed_note(structure, outline, places) for outline, places in own.crossed]
        if not own.faces:
            return None
        self._find_inner_loops(structure, own.faces)
        faces = own.faces
        if (clip := self.clips.get(structure.path)) is not None:
            inner = [replace(face, section=face.section & clip) for face in faces]
            faces = [face for face in inner if not face.section.is_nothing]
        if not faces:
            return None
        self.faces[structure.path] = faces
        return union_of(faces)

    def inner_pieces(self, structure: SolvedStructure, number: int) -> tuple[Piece, ...]:
        """Returns a curve of a structure as far as it lies in what the structure is clipped to."""
        if (clip := self.clips.get(structure.path)) is None:
            return (self.network.curves[number],)
        uses = self.network.uses[number]
        within = clip.mask(self.network.midpoints([edge for edge, _ in uses])) if uses else ()
        return tuple(self.network.piece(use) for use, is_in in zip(uses, within, strict=True) if is_in)

    def _find_inner_loops(self, structure: SolvedStructure, faces: list[OwnFace]) -> None:
        """Faces that the others cover; of two alike the later one."""
        beside: list[list[int]] = [[] for _ in faces]
        for i, j in near_pairs([face.section.box for face in faces], 0.0):
            beside[i].append(j)
            beside[j].append(i)
        dropped: set[int] = set()
        for number in reversed(range(len(faces))):
            face = faces[number]
            near = [faces[i] for i in sorted(beside[number]) if i not in dropped]
            near = [f for f in near if face.section.may_meet(f.section)]
            around = [f for f in near if face.section.is_boxed_by(f.section)]
            if not near or not (around or len(near) > 1):
                continue
            if union_of(near).covers(face.section):
                dropped.add(number)
                names = tuple(g for f in around or near for g in f.geometries)
                self.findings.append(Covered(structure, face, names))
        for number, face in enumerate(faces):
            if number not in dropped:
                others = [faces[i] for i in sorted(beside[number]) if i not in dropped]
                self._find_covered_holes(structure, face, others)

    def _find_covered_holes(self, structure: SolvedStructure, face: OwnFace, others: list[OwnFace]) -> None:
        """Holes of a face of which nothing is left when the others are united with it."""
        if not others or face.section.num_contour() == 1:
            return
        rest, covered, by = union_of(others), 0, dict[str, SolvedGeometry]()
        for hole in face.section.holes():
            if rest.covers(hole):
                covered += 1
                near = [f for f in others if f.section.may_meet(hole)]
                alone = next((f for f in near if f.section.covers(hole)), None)
                by.update((g.path, g) for f in ([alone] if alone else near) for g in f.geometries)
        if covered:
            self.findings.append(Covered(structure, face, tuple(by.values()), covered))

    def _united(
        self, solid: SolvedStructure, own: Section | None, children: list[Mass], cuts: list[Cut]
    ) -> list[Mass]:
        islands = [island for c in cuts for island in c.islands]
        before = union([*([] if own is None else [own]), *(m.section for m in children)])
        taken = union([c.section for c in cuts])
        after = before - taken
        after = union([after, *(m.section for m in islands)]) if islands else after
        kept = self._voids(solid, before, cuts, taken)
        if islands:
            kept = self._still_open(solid, kept, after, islands)
        for m in children:
            kept += self._still_open(solid, m.voids, after, children)
        if after.is_empty:
            return []
        self.sections[solid.path] = after
        for m in (*children, *islands):
            self.sections.setdefault(m.structure.path, m.section)
        inner = [path for m in (*children, *islands) for path in (*m.inner, m.structure.path)]
        return [Mass(solid, after, tuple(kept), tuple(inner))]

    def _separate(
        self, structure: SolvedStructure, own: Section | None, children: list[Mass], cuts: list[Cut]
    ) -> list[Mass]:
        """Returns the masses of an assembly, each cut by its holes, and the islands."""
        masses = ([] if own is None else [Mass(structure, own)]) + children
        if cuts:
            taken = union([c.section for c in cuts])
            self._voids(structure, union([m.section for m in masses]), cuts, taken)
            masses = [replace(m, section=m.section - taken) for m in masses]
            masses += [island for c in cuts for island in c.islands]
        return [m for m in masses if not m.section.is_empty]

    def _voids(
        self, holder: SolvedStructure, material: Section, cuts: Sequence[Cut], taken: Section
    ) -> list[Void]:
        """Returns the material that each hole removes, of all taken; reports holes that remove nothing."""
        voids = []
        near = _around(material, [hole.section for cut in cuts for hole in cut.holes], taken)
        for cut in cuts:
            for hole in cut.holes:
                removed = next(near) & hole.section
                if not removed.is_nothing:
                    voids.append(Void(hole.hole, removed))
                elif not any(m.section.overlaps(hole.section) for m in cut.islands):
                    self.findings.append(idle_hole(hole.hole, holder))
        return voids

    def _still_open(
        self, holder: SolvedStructure, voids: Sequence[Void], material: Section, others: list[Mass]
    ) -> list[Void]:
        """Returns the voids that the material does not fill again; tells of those that it does.

        What a void was cut from does not cover it, so it may be among the others.
        """
        if not voids or not material.overlaps(union([v.section for v in voids])):
            return list(voids)
        kept = []
        for void in voids:
            if material.covers(void.section):
                near = (m for m in others if m.section.may_meet(void.section))
                filler = next((m.structure for m in near if m.section.covers(void.section)), None)
                self.findings.append(_filled_hole(void.hole, holder, filler))
            else:
                kept.append(void)
        return kept


def crossed_note(s: SolvedStructure, outline: SolvedGeometry, places: Sequence[Vec]) -> Diagnostic:
    """Returns the warning on an imported outline that crosses itself."""
    first, *more = sorted(places)
    further = f" and in {counted(len(more), 'more place')}" if more else ""
    rule = "a winding that is not 0" if outline.type == WINDING else "every second area"
    return Diagnostic(
        "W0753",
        f"`{label(outline.path)}`, imported into {s.kind} `{s.path}`, crosses itself at {at(first)}{further}",
        outline.span or s.span,
        f"filled is {rule}",
        hints=(AGAIN, "crossing lines come out of a cutter as separate pieces"),
        points=(first, *more[:9]),
    )


def label(path: str) -> str:
    """Returns what a shape of a file is called there, by its path."""
    return path.rpartition(".")[2].rpartition("[")[0]


AGAIN = "mend it in the program that drew it"


def _around(material: Section, holes: Sequence[Section], taken: Section) -> Iterator[Section]:
    """Yields for each hole the material near it, with which it has the same in common as with all of it.

    All holes together have in common with the material what they have one by one, in small components.
    """
    if len(holes) < _FEW_HOLES or material.num_vert() < _FEW_VERTICES:
        yield from (material for _ in holes)
        return
    parts = (material & taken).decompose()
    beside: list[list[Section]] = [[] for _ in holes]
    for i, j in near_pairs([s.box for s in (*parts, *holes)], 0.0):
        if i < len(parts) <= j:
            beside[j - len(parts)].append(parts[i])
    yield from map(union, beside)


def idle_hole(hole: SolvedStructure, holder: SolvedStructure | None) -> Diagnostic:
    """Returns the warning on a hole that removes nothing from the structure that holds it."""
    if holder is None:
        return Diagnostic(
            "W0703",
            f"hole `{hole.path}` cuts nothing: no structure holds it",
            hole.span,
            "the root of the program is a hole",
            hints=(f"write it inside the solid it shall cut: `solid … {{ hole {hole.name} {{ … }} }}`",),
        )
    below = hole.path.removeprefix(f"{holder.path}.")
    hints = [
        f"place it inside: `constrain inside({below}, …)` in `{holder.path}`, or move it to "
        "the structure that it shall cut: a hole cuts the structure that holds it, with all its children"
    ]
    if hole.box and holder.box:
        hints.insert(0, f"the hole spans {_spans(hole)}, `{holder.name}` spans {_spans(holder)}")
    return Diagnostic(
        "W0703",
        f"hole `{hole.path}` removes nothing from {holder.kind} `{holder.path}`",
        hole.span,
        "no material here",
        (Label(holder.span, "holds the hole"),) if holder.span else (),
        tuple(hints),
    )


def _spans(structure: SolvedStructure) -> str:
    box = structure.box
    assert box is not None
    return f"{at((box.left, box.bottom))} to {at((box.right, box.top))}"


def _filled_hole(
    hole: SolvedStructure, holder: SolvedStructure, filler: SolvedStructure | None
) -> Diagnostic:
    """Returns the warning on a hole whose void is material again in the structure above."""
    by = f"`{filler.path}`" if filler else "other material"
    hints = [f"to cut all of `{holder.path}`, move the hole up into it, beside the parts that it shall cut"]
    if filler is not None and holder.kind == "solid":
        hints.append(
            f"to keep `{filler.name}` a part of its own in the hole, make `{holder.name}` an `assembly`"
        )
    return Diagnostic(
        "W0704",
        f"hole `{hole.path}` is filled again by {by} in {holder.kind} `{holder.path}`",
        hole.span,
        "nothing of this hole remains",
        (Label(filler.span, "fills it"),) if filler and filler.span else (),
        tuple(hints),
    )


# --- The edges of united structures and geometries that run inside their body: fine lines in pictures,
# nothing in cutting formats.


def visible_seams(walk: Bodies, mass: Mass) -> Iterator[tuple[str, tuple[Piece, ...]]]:
    """Yields the edges of each united structure inside the body, by its path, each drawn once."""
    outlines = {path: walk.sections[path].edges for path in mass.inner}
    candidates = sorted(frozenset[int]().union(*outlines.values()) - mass.section.edges)
    mask = mass.section.mask(walk.network.midpoints(candidates))
    left = {edge for edge, within in zip(candidates, mask, strict=True) if within}
    for path in mass.inner:
        edges = sorted(outlines[path] & left)
        left.difference_update(edges)
        if edges:
            yield path, tuple(_merged(walk.network, edges))


def inner_seams(walk: Bodies, mass: Mass, asked: Collection[str]) -> Iterator[tuple[str, tuple[Piece, ...]]]:
    """Yields the edges of the faces that the `asked` structures of a body draw, as far as they lie inside it
    and no later face of the structure, and no structure in it, lies over them; by the path of the structure,
    each drawn once.
    """
    network, paths = walk.network, (*mass.inner, mass.structure.path)
    taken = {edge for path in paths for edge in walk.sections[path].edges}
    for path in paths:
        own = [face.section for face in walk.faces.get(path, ()) if path in asked]
        over = union([walk.sections[inner] for inner in mass.inner if inner.startswith(f"{path}.")])
        found: set[int] = set()
        traced(own)  # all at once
        for section in reversed(own):
            candidates = sorted(section.edges - taken)
            spots = network.midpoints(candidates)
            seen = mass.section.mask(spots) & ~over.mask(spots)
            found.update(edge for edge, is_seen in zip(candidates, seen, strict=True) if is_seen)
            taken.update(candidates)
            over = union([over, section])
        if found:
            yield path, tuple(_merged(network, sorted(found)))


def _merged(network: Network, numbers: Iterable[int]) -> Iterator[Piece]:
    """Yields edges that follow each other on one curve as one piece."""
    edges = (network.edges[number] for number in numbers)
    for run in in_runs(edges, lambda a, b: a.curve == b.curve and a.t1 == b.t0):
        first, last, nodes = run[0], run[-1], network.nodes
        yield network.curves[first.curve].part(first.t0, last.t1, nodes[first.start], nodes[last.end])


# --- Closes outlines with small gaps: open ends of curves that lie close together become one, and each gap is
# reported.
#
# Numbers written by hand have two or three decimals, so the ends of two curves that are meant to meet may be
# a hundredth of a millimetre apart. One of them is moved onto the other, and its curve changes as little as
# that takes: it stays a line, an arc, a Bézier curve. Only curves that enclose nothing otherwise are joined,
# and only where they enclose something then.

WIDEST = 5e-4
"""Width of a gap that is closed, relative to the size of the drawing: two decimals in a drawing of 30 mm."""
WIDEST_MM = 0.05
ROUNDING = 1e-8
"""Distance of two ends, relative to the size, that is rounding and no gap."""


@record()
class End:
    """The start or the end of a curve, by its number in the network."""

    geometry: SolvedGeometry
    number: int
    at: Vec
    is_last: bool


@record()
class Gap:
    """Two ends that count as one: `moved` was brought to where `kept` is."""

    structure: SolvedStructure
    moved: End
    kept: End

    @property
    def width(self) -> float:
        return math.dist(self.moved.at, self.kept.at)


def with_gaps_closed(
    network: Network,
    root: SolvedStructure,
    shapes: Mapping[str, Sequence[Shape]],
    arranged: Callable[[Network], Bodies],
) -> tuple[Bodies, list[Gap]]:
    """Returns what is arranged of the network with small gaps between curves closed, and these gaps."""
    found = with_finer_chords(network, arranged)
    gaps = _open_gaps(network, found.findings, shapes)
    while gaps:
        joined = Network(_without_gaps(network.curves, gaps), box=network.box)
        then = with_finer_chords(joined, arranged)
        kept = list(_effective(gaps, then.findings))
        if len(kept) == len(gaps):
            found = then
            break
        gaps = kept
    welded = _welded_gaps(found.network, root.walk(), shapes)
    return found, [*gaps, *_effective(welded, found.findings)]


def _open_gaps(
    network: Network, findings: Iterable[Finding], shapes: Mapping[str, Sequence[Shape]]
) -> list[Gap]:
    """Returns the gaps beside curves of solids and holes that enclose nothing, narrow enough to be closed."""
    widest = min(WIDEST * network.size, WIDEST_MM)
    curves = list(network.curves)
    gaps = []
    for finding in findings:
        if not isinstance(finding, LooseCurves) or finding.structure.kind not in ("solid", "hole"):
            continue
        loose = {number for _, number in finding.curves}
        of = shapes[finding.structure.path]
        meeting = network.meeting(number for shape in of for number in shape.numbers)
        free = [end for end in _ends_of_open(network, of) if meeting[network.node(end.at)] == 1]
        for a, b in _nearest_first(free, widest):
            if not loose & {a.number, b.number}:
                continue
            for moved, kept in ((b, a), (a, b)):
                curve = _with_end(curves[moved.number], moved.is_last, kept, widest)
                if curve is not None:
                    curves[moved.number] = curve
                    gaps.append(Gap(finding.structure, moved, kept))
                    break
    return gaps


def _without_gaps(curves: Sequence[Piece], gaps: Iterable[Gap]) -> list[Piece]:
    """Returns the curves with the moved ends where they are to be."""
    result = list(curves)
    for gap in gaps:
        number, widest = gap.moved.number, 2 * gap.width
        result[number] = _with_end(result[number], gap.moved.is_last, gap.kept, widest) or result[number]
    return result


def _effective(gaps: Iterable[Gap], findings: Iterable[Finding]) -> Iterator[Gap]:
    """Yields the gaps whose curves both enclose something."""
    loose = {number for f in findings if isinstance(f, LooseCurves) for _, number in f.curves}
    return (gap for gap in gaps if not loose & {gap.moved.number, gap.kept.number})


def _welded_gaps(
    network: Network, structures: Iterable[SolvedStructure], shapes: Mapping[str, Sequence[Shape]]
) -> Iterator[Gap]:
    """Yields gaps between ends, in outlines of single curves, that became one node without quite meeting."""
    for structure in structures:
        if structure.kind not in ("solid", "hole"):
            continue
        meeting: dict[int, list[End]] = defaultdict(list)
        for shape in shapes[structure.path]:
            if not shape.geometry.parts:
                for end in _ends_of_open(network, [shape]):
                    meeting[network.node(end.at)].append(end)
        for here in meeting.values():
            first = here[0]
            last = max(here, key=lambda end: math.dist(end.at, first.at))
            if math.dist(last.at, first.at) > ROUNDING * network.size:
                yield Gap(structure, last, first)


def ends_of(network: Network, geometry: SolvedGeometry, number: int) -> Iterator[End]:
    """Yields both ends of a curve."""
    for spot, is_last in zip(network.curves[number].ends, (False, True), strict=True):
        yield End(geometry, number, spot, is_last)


def _ends_of_open(network: Network, shapes: Iterable[Shape]) -> Iterator[End]:
    leaves = (leaf for shape in shapes for leaf in shape.leaves if not network.curves[leaf[1]].is_closed)
    return (end for leaf in leaves for end in ends_of(network, *leaf))


def _nearest_first(found: Sequence[End], widest: float) -> Iterator[tuple[End, End]]:
    """Yields pairs of ends, each end once, the nearest pair first, in each the one written earlier first."""
    boxes = [(*end.at, *end.at) for end in found]
    pairs = sorted((math.dist(found[i].at, found[j].at), i, j) for i, j in near_pairs(boxes, widest))
    taken: set[int] = set()
    for distance, i, j in pairs:
        if distance <= widest and not taken & {i, j}:
            taken |= {i, j}
            yield found[i], found[j]


def _with_end(curve: Piece, is_last: bool, kept: End, widest: float) -> Piece | None:
    """Returns such a curve with its end elsewhere; None if that would change more than its end."""
    if larger_side(curve.box) <= 10 * widest:
        return None
    start, end = curve.ends
    start, end = (start, kept.at) if is_last else (kept.at, end)
    if isinstance(curve, Line):
        return Line(start, end)
    if isinstance(curve, Bezier):
        (ax, ay), (bx, by) = _way(curve.p0, start), _way(curve.p3, end)
        p1, p2 = (curve.p1[0] + ax, curve.p1[1] + ay), (curve.p2[0] + bx, curve.p2[1] + by)
        return Bezier(start, p1, p2, end)
    return _arc_through(curve, start, end, widest) if isinstance(curve, Arc) else None


def _way(p: Vec, q: Vec) -> Vec:
    return q[0] - p[0], q[1] - p[1]


def _arc_through(arc: Arc, start: Vec, end: Vec, widest: float) -> Arc | None:
    """Returns the arc between two points whose centre is nearest to that of another, and not far from it."""
    if start == end:
        return replace(arc, start=start, end=end, sweep=math.copysign(math.tau, arc.sweep))
    (x, y), (cx, cy), (dx, dy) = start, arc.center, _way(start, end)
    chord = math.hypot(dx, dy)
    off = ((cx - (x + end[0]) / 2) * dx + (cy - (y + end[1]) / 2) * dy) / chord
    center = cx - off * dx / chord, cy - off * dy / chord
    radius = math.dist(center, start)
    if math.dist(center, arc.center) > 2 * widest or abs(radius - arc.radius) > 2 * widest:
        return None
    first, last = (math.atan2(p[1] - center[1], p[0] - center[0]) for p in (start, end))
    sweep = arc.sweep + math.remainder(last - first - arc.sweep, math.tau)
    return Arc(center, radius, start, end, sweep) if 0 < abs(sweep) < math.tau else None
