"""The drawing of a solved model: bodies with exact outlines, strokes, seams, contacts."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import TypeAlias

from aidl_lang.common.colors import css_color
from aidl_lang.common.diagnostics import Diagnostic, by_statement, ordered
from aidl_lang.common.records import record
from aidl_lang.common.running import Later
from aidl_lang.geometry import legibility
from aidl_lang.geometry.bodies import (
    Bodies,
    Clips,
    Covered,
    LooseCurves,
    Mass,
    clip_sections,
    clip_shapes,
    empty_clips,
    idle_hole,
    inner_seams,
    visible_seams,
    with_gaps_closed,
)
from aidl_lang.geometry.boolean import Contact, Contacts, Solid, contacts, lettered_region
from aidl_lang.geometry.curves import Bounds, Piece, has_extent, larger_side, union_bounds, usable
from aidl_lang.geometry.faces import ENGRAVED, Shape, own_faces, region_of, union_of
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.notes import finding_notes, gap_note, stroked_note, unusable_note, upright_note
from aidl_lang.geometry.pieces import LETTERING, detached_notes, piece_notes
from aidl_lang.geometry.region import Face, Measures, Region, measure
from aidl_lang.geometry.sections import Section, section_of, traced, union
from aidl_lang.geometry.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.geometry.styles import (
    Style,
    idle_areas,
    idle_looks,
    idle_orders,
    is_filled,
    is_inlay,
    places_of,
    stacked,
    styled,
    styles_of,
    united_parts,
    veils,
)

SLIT = "slit"
_Curves: TypeAlias = tuple[list[Piece], list[Bounds]]
_Shapes: TypeAlias = dict[str, list[Shape]]


@record()
class Body:
    """A piece of material: a solid that no other solid holds, or what an assembly draws itself."""

    path: str
    region: Region
    style: Style

    @property
    def box(self) -> Bounds:
        return self.region.box


@record()
class Seam:
    """The edges of a structure that was united with the body around it, or of geometries that it is united
    of, where they run inside that body. `is_asked`: the program asks for seams.
    """

    path: str
    body: str
    pieces: tuple[Piece, ...]
    is_asked: bool = False


@record()
class Stroke:
    """Curves drawn as lines.

    `role` is `drawing` for the curves of a drawing and the outlines of holes that end in
    their solid, `open` for curves of other structures that bound no face,
    `hole` for the outline of a hole that nothing holds, `slit` for gaps that one cut makes.
    `over`: the colour of what it lies on, where its own was not said for it and may not be seen there: lines
    that have the same, and all letters. `faces`: what letters enclose,
    or an area with a look of its own (`is_area`), which is filled where it can be; `pieces` are their
    outlines. `whole`: that of an area before others covered some of it, as its shade runs.
    """

    path: str
    geometry: str
    pieces: tuple[Piece, ...]
    style: Style
    role: str = "drawing"
    over: str | None = None
    faces: tuple[Face, ...] = ()
    whole: tuple[Piece, ...] = ()

    @property
    def is_area(self) -> bool:
        return bool(self.whole)


@record()
class _Area:
    """An area with a look of its own: what is seen of it, the `whole` as it lies below what is in the colour
    of the body again, and curves that bound none of it.
    """

    seen: Solid
    whole: Section
    loose: tuple[Piece, ...] = ()


_Areas: TypeAlias = Mapping[str, _Area]


@record()
class PlanBox:
    """The box of a structure whose parts are not drawn yet."""

    path: str
    name: str
    box: Bounds


@record()
class Drawing:
    """All that is to be seen: bodies in order of writing, strokes from back to front. Coordinates in mm in
    the root frame.

    `regions` has every solid and every hole, each as it stands before the structures around it change it, and
    the bodies as they are in the end. `box` bounds bodies and strokes, not the plans.
    """

    bodies: tuple[Body, ...]
    regions: dict[str, Region]
    seams: tuple[Seam, ...]
    strokes: tuple[Stroke, ...]
    plans: tuple[PlanBox, ...]
    contacts: Contacts
    styles: dict[str, Style]
    box: Bounds

    @cached_property
    def measures(self) -> dict[str, Measures]:
        """Area, perimeter, centroid and box of each region."""
        return {path: measure(region) for path, region in self.regions.items()}

    @property
    def pairs(self) -> tuple[Contact, ...]:
        """The contacts between the bodies."""
        return self.contacts.all()

    @property
    def size(self) -> float:
        """The larger side of the box, 1 for an empty drawing."""
        return larger_side(self.box) or 1.0


@record()
class Findings:
    """What there is to tell of a drawing: the errors, and what works out all of it, these among it."""

    errors: Sequence[Diagnostic]
    everything: Callable[[], list[Diagnostic]]


def draw(model: SolvedModel) -> tuple[Drawing, Findings]:
    """Returns the drawing of a model, and diagnostics on its curves and parts."""
    root, unusable = model.root, list[Diagnostic]()
    (curves, boxes), ink, shapes, engraved = _collect(root, unusable)
    clips, around = clip_shapes(root, len(curves))
    boxes += (piece.box for piece in around)
    network = Network([*curves, *around], boxes, union_bounds([*boxes, *ink[1]]))
    styles = styles_of(root)
    blind = [path for path, style in styles.items() if style.is_blind]
    veiled = list(veils(root, styles))
    aside = frozenset(path for _, seen, _ in veiled for path in seen)
    of_bodies = styles | {
        s: replace(styles[s], opacity=0.0, stroke=0.0) for s, _, is_bare in veiled if is_bare
    }
    made = {path: [s for s in of if s.geometry.path not in aside] for path, of in shapes.items()}
    walk, gaps = with_gaps_closed(network, root, shapes, partial(_arranged, root, made, clips, blind))
    network, masses = walk.network, walk.bodies
    regions = {path: section.region for path, section in walk.sections.items()}
    bodies = tuple(Body(m.structure.path, m.section.region, of_bodies[m.structure.path]) for m in masses)
    order = places_of(root)
    solids = [
        Solid(b.path, m.section, order[b.path], b.style.color, b.style.is_clear)
        for b, m in zip(bodies, masses, strict=True)
    ]
    touching = contacts(network, solids)
    inlaid = {s.path for s in root.walk() if is_inlay(s)}  # whose outlines are those of areas
    seams = tuple(
        Seam(path, m.structure.path, pieces, is_asked=styles[path].has_seams)
        for m in masses
        if m.inner
        for path, pieces in visible_seams(walk, m)
        if path not in inlaid
    )
    asked = {path for path in walk.faces if styles[path].has_seams}
    seams += tuple(
        Seam(path, m.structure.path, pieces, is_asked=True)
        for m in (masses if asked else ())
        for path, pieces in inner_seams(walk, m, asked)
    )
    scene = _Scene(root, shapes, engraved, styles, order, walk)
    areas = dict(scene.areas(aside, ink[0]))
    lying = [*solids, *(area.seen for area in areas.values())]
    ground = legibility.Ground(network, sorted(lying, key=lambda body: body.place), *ink, order)
    strokes = tuple(scene.strokes(areas, regions, ground))
    drawn = {s.path for s in strokes} | {path for path, region in regions.items() if region}
    empty = list(empty_clips(root, drawn))

    def everything() -> list[Diagnostic]:
        paths = [b.path for b in bodies]
        notes = [*unusable, *map(gap_note, gaps), *legibility.crossing_notes(network, root, shapes)]
        notes += [
            upright_note(s)
            for s in root.walk()
            if len(styles[s.path].depth) > 1 and s.path in regions and regions[s.path].circle is None
        ]
        for f in walk.findings:
            if not (isinstance(f, Covered) and scene.is_seen(f, areas)):
                notes += finding_notes(f, network)
        notes += detached_notes(root, paths, touching)
        notes += piece_notes(root, walk, solids, touching.near())
        notes += [*scene.unseen(ground), *scene.covered_letters(ground)]
        notes += legibility.overhanging_notes(root, bodies, strokes)
        notes += legibility.colliding_notes(root, strokes, network.tolerance)
        if any(body.style.material for body in bodies):
            from aidl_lang.geometry.walls import thin_wall_notes

            notes += thin_wall_notes(root, [(b.path, b.region, b.style.material) for b in bodies])
        loose = {g.path for f in walk.findings if isinstance(f, LooseCurves) for g, _ in f.curves}
        notes += [*idle_looks(root, paths, styles), *idle_areas(root, areas, loose)]
        notes += idle_orders(root, paths)
        return ordered(by_statement([*notes, *empty]))

    plans = tuple(PlanBox(s.path, s.name, s.box.bounds) for s in root.walk() if s.is_empty and s.box)
    boxes = [b.box for b in bodies]
    boxes += (piece.box for s in strokes for piece in s.pieces)
    drawing = Drawing(bodies, regions, seams, strokes, plans, touching, styles, union_bounds(boxes))
    return drawing, Findings([d for d in (*unusable, *empty) if d.is_error], Later(everything))


def _arranged(
    root: SolvedStructure, shapes: _Shapes, clips: Clips, blind: Collection[str], network: Network
) -> Bodies:
    """Returns the walk with its bodies, and with the sections of all that has material or cuts in order of
    writing, their regions found.
    """
    walk = Bodies(network, shapes, dict(clip_sections(network, root, clips)), blind)
    masses = _root_masses(walk, root)
    walk.sections.update((m.structure.path, m.section) for m in masses)
    walk.sections = {s.path: walk.sections[s.path] for s in root.walk() if s.path in walk.sections}
    traced(list(walk.sections.values()))
    walk.bodies = [m for m in masses if m.section.region]
    return walk


def _collect(root: SolvedStructure, notes: list[Diagnostic]) -> tuple[_Curves, _Curves, _Shapes, _Shapes]:
    """Returns all curves that can be drawn, numbered, with their boxes: those that bound material, and those
    of strokes, which nothing is cut by. And by structure the shapes they belong to, and the outlines that a
    file says are engraved.
    """
    solid: _Curves = ([], [])
    ink: _Curves = ([], [])
    shapes: _Shapes = {}
    engraved: _Shapes = {}
    for structure in root.walk():
        own = shapes.setdefault(structure.path, [])
        for geometry in structure.drawn:
            if structure.kind in ("solid", "hole") and _has_strokes(geometry):
                notes.append(stroked_note(structure, geometry))
                continue
            leaves = []
            vanished = []
            on_part = {id(leaf) for part in geometry.walk() if part.type == ENGRAVED for leaf in part.parts}
            for leaf in geometry.leaves():
                curve = usable(leaf.curve) if leaf.curve else None
                if curve is None or not has_extent(box := curve.box):
                    vanished.append(leaf)
                    continue
                curves, boxes = ink if structure.kind == "drawing" or id(leaf) in on_part else solid
                leaves.append((leaf, len(curves)))
                curves.append(curve)
                boxes.append(box)
            numbers = {id(leaf): (leaf, number) for leaf, number in leaves}
            engraved.setdefault(structure.path, []).extend(
                Shape(part, tuple(numbers[id(leaf)] for leaf in part.parts if id(leaf) in numbers))
                for part in geometry.walk()
                if part.type == ENGRAVED
            )
            leaves = [leaf for leaf in leaves if id(leaf[0]) not in on_part]
            if leaves:
                # A shape may have edges of no length (a rounded rectangle with half-round ends).
                own.append(Shape(geometry, tuple(leaves)))
                vanished = [leaf for leaf in vanished if leaf.curve and not leaf.curve.is_finite()]
            notes += [unusable_note(structure, leaf, leaf if leaves else geometry) for leaf in vanished[:1]]
    return solid, ink, shapes, engraved


def _has_strokes(geometry: SolvedGeometry) -> bool:
    return not geometry.construction and (geometry.stroked or any(map(_has_strokes, geometry.parts)))


def _root_masses(walk: Bodies, root: SolvedStructure) -> list[Mass]:
    """Returns the bodies; a root that is a hole has nothing to cut, and leaves its islands."""
    if root.kind != "hole":
        return walk.masses(root)
    cut = walk.cut(root)
    if cut.holes:
        walk.findings.append(idle_hole(root, None))
    return list(cut.islands)


@record()
class _Scene:
    """What is drawn of a model: its curves by structure, their looks and order, and what they bound."""

    root: SolvedStructure
    shapes: _Shapes
    engraved: _Shapes
    styles: dict[str, Style]
    order: Mapping[str, int]
    walk: Bodies

    @cached_property
    def colored(self) -> set[str]:
        """The paths of drawings with a colour of their own, or from a drawing around them."""
        return {
            below.path
            for s in self.root.walk()
            if s.kind == "drawing" and css_color(s.attributes.get("color", ()))
            for below in s.walk()
        }

    def _has_own_color(self, drawing: SolvedStructure, shape: Shape) -> bool:
        return drawing.path in self.colored or "color" in shape.geometry.attributes

    def areas(self, aside: Collection[str], ink: Sequence[Piece]) -> Iterator[tuple[str, _Area]]:
        """Yields the paths and areas of geometry with a look of its own: what it encloses of its body, or all
        but the holes in it if it lies `aside`, as a veil.
        """
        network = self.walk.network
        mass_of = {part.path: m for m in self.walk.bodies for part in united_parts(m.structure)}
        plain: dict[str, list[Shape]] = {}  # by body: what has its colour
        for path, m in mass_of.items():
            of = (s for s in self.shapes[path] if not is_filled(s.geometry, m.structure.kind))
            plain.setdefault(m.structure.path, []).extend(of)
        above: dict[tuple[str, int], Section] = {}  # by body, and how many of these lie above
        for structure in self.root.walk():
            mass, clip = mass_of.get(structure.path), self.walk.clips.get(structure.path)
            for shape in self.shapes[structure.path] if structure.kind != "hole" else ():
                g, place = shape.geometry, self.order[shape.geometry.path]
                if not is_filled(g, structure.kind):
                    continue
                loose: tuple[Piece, ...] = ()
                if structure.kind == "drawing":
                    found = list(_told_apart([shape], ink, is_area=True))
                    region = Region(next((faces for _, faces in found if faces), ()))
                    loose = next((lines for lines, faces in found if not faces), ())
                    whole = section = section_of(region, network)
                else:
                    whole = union_of(own_faces(network, [shape]).faces)
                    if g.path in aside:
                        whole = whole - union([v.section for v in mass.voids] if mass else [])
                    else:
                        whole = whole & (mass.section if mass else union([]))
                    section = whole = whole & clip if clip is not None else whole
                    body = mass.structure.path if mass else ""
                    if later := [s for s in plain.get(body, ()) if self.order[s.geometry.path] > place]:
                        if (key := (body, len(later))) not in above:
                            above[key] = union_of(own_faces(network, later).faces)
                        section = section - above[key]  # in the colour of the body again
                if section.region:
                    look = styled(self.styles[structure.path], g)
                    seen = Solid(g.path, section, place, look.color, look.is_clear)
                    yield g.path, _Area(seen, whole, loose)

    def strokes(
        self, areas: _Areas, regions: dict[str, Region], ground: legibility.Ground
    ) -> Iterator[Stroke]:
        """Yields the curves of drawings, and those of other structures that bound nothing."""
        loose = {f.structure.path: f.curves for f in self.walk.findings if isinstance(f, LooseCurves)}
        for structure in stacked(self.root):
            path, style = structure.path, self.styles[structure.path]
            if structure.kind == "drawing":
                yield from self._inked(structure, ground, areas)
            for shape in self.engraved.get(path, ()):
                look = styled(replace(style, color=None), shape.geometry)
                for pieces, faces in _told_apart([shape], ground.curves, is_area=look.is_area):
                    yield Stroke(path, shape.geometry.path, pieces, look, faces=faces)
            if structure.kind != "drawing":
                for geometry in structure.drawn:
                    if geometry.path in areas:
                        yield from _colored(structure, geometry, style, areas[geometry.path])
            if style.is_blind and path in regions:
                yield Stroke(path, path, regions[path].pieces, style, over=style.color)
            for leaf, number in loose.get(path, ()):
                if pieces := self.walk.inner_pieces(structure, number):
                    yield Stroke(path, leaf.path, pieces, style, "open")
        if self.root.kind == "hole" and self.root.path in regions:
            path = self.root.path
            yield Stroke(path, path, regions[path].pieces, self.styles[path], "hole")

    def _inked(self, drawing: SolvedStructure, ground: legibility.Ground, areas: _Areas) -> Iterator[Stroke]:
        alike: dict[tuple[Style, str | None, str | None], list[Shape]] = {}
        place, style = self.order[drawing.path], self.styles[drawing.path]
        for shape in self.shapes[drawing.path]:
            look = styled(style, shape.geometry)
            is_asked = self._has_own_color(drawing, shape)
            is_hidden = not is_asked and ground.hides(look.color, shape.numbers, place, wholly=False)
            over = look.color if is_hidden else None
            if not is_asked and not is_hidden and shape.geometry.type == LETTERING:
                over = ground.below(shape.numbers, place)
            # What is engraved as areas is one area, the rest a stroke for each shape.
            alike.setdefault((look, over, None if look.is_area else shape.geometry.path), []).append(shape)
        for (look, over, _), together in alike.items():
            geometry = together[0].geometry
            if geometry.path in areas and not look.is_area:
                yield from _colored(drawing, geometry, style, areas[geometry.path])
                continue
            for pieces, faces in _told_apart(together, ground.curves, is_area=look.is_area):
                yield Stroke(drawing.path, geometry.path, pieces, look, over=over, faces=faces)

    def is_seen(self, found: Covered, areas: _Areas) -> bool:
        """Tells whether a face that adds nothing is drawn: by seams, as an area, or on one."""
        own, structure = found.face.geometries, found.structure
        if self.styles[structure.path].has_seams or any(is_filled(g, structure.kind) for g in own):
            return True
        place = max(self.order[g.path] for g in own)
        below = (area.whole for path, area in areas.items() if self.order[path] <= place)
        return any(area.overlaps(found.face.section) for area in below)

    def unseen(self, ground: legibility.Ground) -> Iterator[Diagnostic]:
        """Yields warnings on strokes in the colour below, or under a body unless one of an array shows."""
        for drawing in (s for s in stacked(self.root) if s.kind == "drawing"):
            lost: dict[str, list[str]] = {}
            covered: dict[str, list[str]] = {}
            seen: set[str] = set()
            for shape in self.shapes[drawing.path]:
                look, numbers = styled(self.styles[drawing.path], shape.geometry), shape.numbers
                place = self.order[shape.geometry.path]
                if (by := ground.covering(numbers, place)) is not None:
                    covered.setdefault(by, []).append(shape.geometry.name)
                else:
                    seen.add(shape.geometry.name.partition("[")[0])
                if by is None and shape.geometry.type == LETTERING:
                    share, over_it = ground.covered_part(numbers, place)
                    if share >= legibility.COVERED:
                        yield legibility.lettering_note(drawing, shape.geometry, share, over_it)
                is_asked = self._has_own_color(drawing, shape)
                if is_asked and look.color and ground.hides(look.color, numbers, place, wholly=True):
                    lost.setdefault(look.color, []).append(shape.geometry.name)
            yield from (legibility.unseen_note(drawing, names, color) for color, names in lost.items())
            for by, names in covered.items():
                if whole := [name for name in names if name.partition("[")[0] not in seen]:
                    yield legibility.covered_note(drawing, whole, by)

    def covered_letters(self, ground: legibility.Ground) -> Iterator[Diagnostic]:
        """Warnings about letters of solids and holes that later bodies lie over."""
        # The masses of an assembly follow its own.
        place = {s.path: self.order[m.structure.path] for m in self.walk.bodies for s in m.structure.walk()}
        for structure in self.root.walk():
            for face in self.walk.faces.get(structure.path, ()) if structure.path in place else ():
                if all(g.type == LETTERING for g in face.geometries):
                    share, by = ground.hidden_part(face.section, place[structure.path])
                    if share >= legibility.COVERED:
                        yield legibility.lettering_note(structure, face.geometries[0], share, by)


def _colored(
    structure: SolvedStructure, geometry: SolvedGeometry, style: Style, area: _Area
) -> Iterator[Stroke]:
    look, seen, whole = styled(style, geometry), area.seen.section.region, tuple(geometry.curves())
    yield Stroke(structure.path, geometry.path, seen.pieces, look, faces=seen.faces, whole=whole)
    if area.loose:
        yield Stroke(structure.path, geometry.path, area.loose, look)


def _told_apart(
    shapes: Sequence[Shape], curves: Sequence[Piece], *, is_area: bool
) -> Iterator[tuple[tuple[Piece, ...], tuple[Face, ...]]]:
    """Yields the lines of shapes, and with its faces the outlines of what is filled of them: letters, what
    closed shapes of a file enclose together, as in a solid, and all that is to be an area.
    """
    drawn = {id(leaf): curves[number] for shape in shapes for leaf, number in shape.leaves}
    parts = [part for shape in shapes for part in shape.geometry.walk() if is_area or part.filled]
    filled = {id(leaf) for part in parts for leaf in (part, *part.parts)} & drawn.keys()
    letters = [part.walk() for part in parts if part.type == "glyph"]
    written = [[drawn[id(leaf)] for leaf in letter if id(leaf) in filled] for letter in letters]
    region = lettered_region(written) if sum(map(len, written)) == len(filled) > 0 else None
    if region is None:
        known = (
            (s.geometry, [(leaf, curves[k]) for leaf, k in s.leaves if id(leaf) in filled]) for s in shapes
        )
        region, loose = region_of((g, leaves) for g, leaves in known if leaves)
        filled -= {id(leaf) for leaf in loose}
    if lines := tuple(curve for leaf, curve in drawn.items() if leaf not in filled):
        yield lines, ()
    if region:
        yield region.pieces, region.faces


def region_alone(root: SolvedStructure, path: str) -> Region:
    """Returns the region that a geometry would cover as a solid of its own."""
    found = (g for g in all_geometry(root) if g.path == path)
    geometry = tuple(replace(g, construction=False) for g in found)
    frame = Frame(0.0, 0.0, 0.0)
    alone = SolvedStructure("it", "it", "solid", "top", frame, {}, {}, geometry, (), None, False, None)
    return draw(SolvedModel("solved", alone))[0].regions.get("it", Region(()))


def all_geometry(root: SolvedStructure) -> Iterator[SolvedGeometry]:
    """Yields every piece of geometry under a structure, as it is drawn, with the parts of each."""
    return (g for structure in root.walk() for drawn in structure.drawn for g in drawn.walk())
