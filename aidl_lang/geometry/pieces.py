"""Warns of bodies that touch no other, of solids that fall into pieces which nothing joins, and of pieces
that a hole cuts free all around.

Where no hole is between them, pieces that are alike are a pattern and meant, as are letters, and what a
single geometry consists of.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.prose import named, rough
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.bodies import Bodies, Mass
from aidl_lang.geometry.boolean import UNNOTICED, Contacts, Solid, lie_within, nearest_region
from aidl_lang.geometry.faces import OwnFace, union_of
from aidl_lang.geometry.intersect import near_pairs
from aidl_lang.geometry.network import Joined
from aidl_lang.geometry.sections import Section, traced, union
from aidl_lang.geometry.solved import SolvedStructure

_RING = 3
"""Outlines that a solid has at least where a piece of it lies in an opening of another."""
_PATTERN = 4
"""Least number of pieces of one area, or of one definition, that are a pattern."""
_MOST = 3
"""Loose pieces of a solid that are told."""
LETTERING = "text"
"""The type of letters."""


def marked_detached(root: SolvedStructure) -> set[str]:
    """Returns the paths of structures that are `@detached`, or lie in one that is."""
    return {
        below.path
        for s in root.walk()
        if "detached" in s.attributes and s.attributes["detached"] != (False,)
        for below in s.walk()
    }


def detached_notes(root: SolvedStructure, paths: Sequence[str], contacts: Contacts) -> list[Diagnostic]:
    """Returns a warning for each statement with bodies that touch and overlap none of the others."""
    free = marked_detached(root)
    if sum(path not in free for path in paths) < 2:
        return []  # there is nothing that a part could touch
    held = {path for pair in contacts.near() for path in pair}
    structures = {s.path: s for s in root.walk()}
    lonely: dict[object, list[SolvedStructure]] = {}
    for path in paths:
        if path not in held and path not in free:
            lonely.setdefault(structures[path].span or path, []).append(structures[path])
    return [_detached(alike, contacts.nearest(alike[0].path)) for alike in lonely.values()]


def _detached(structures: Sequence[SolvedStructure], nearest: tuple[float, str]) -> Diagnostic:
    """Returns the warning about the bodies of one statement; `nearest` is what is nearest to the first."""
    structure, is_one = structures[0], len(structures) == 1
    to = "" if is_one else f" to `{structure.path}`"
    message = (
        f"{named(s.path for s in structures)} {'touches' if is_one else 'touch'} no other part; "
        f"the nearest{to}, `{nearest[1]}`, is {rough(nearest[0])} mm away"
    )
    hints = (
        "to join them, let their borders meet: `gap: 0`, `touching(…)` or `on_top_of(…)`",
        "if that is meant, say so: `@detached` before its definition",
    )
    span, fix = structure.span, None
    is_plain = span and re.match(r"(@|[a-z]+\s+\w+\s*(\[|\(|\{|at\b|rotated\b))", span.text)
    if span and is_plain and "detached" not in structure.attributes:
        fix = Fix("say that it is meant", (Edit(Span(span.source, span.start, span.start), "@detached "),))
    label = "stands by itself" if is_one else "each stands by itself"
    return Diagnostic("W0705", message, span, label, hints=hints, fix=fix)


@record()
class _Piece:
    section: Section
    faces: tuple[OwnFace, ...]


def _meet(one: Section, other: Section) -> bool:
    return one.overlaps(other) or lie_within(one.region, other.region, UNNOTICED)


def piece_notes(
    root: SolvedStructure, walk: Bodies, solids: Sequence[Solid], pairs: Sequence[tuple[str, str]]
) -> Iterator[Diagnostic]:
    """Yields a warning for pieces of a solid that no chain of touching pieces links to the rest, and for each
    hole that cuts pieces free which nothing holds, as the inside of an O. A solid that is the whole program
    is a drawing without parts, in which gaps are as good as lines.
    """
    free = marked_detached(root)
    known = {solid.path: solid for solid in solids}
    for mass in walk.bodies:
        solid = mass.structure
        if solid is not root and solid.kind == "solid" and solid.path not in free:
            pieces = _pieces(walk, mass)
            if len(pieces) > 1:
                yield from _notes(solid, _groups(pieces, known[solid.path], known, pairs))
    held, holes = defaultdict[str, list[Solid]](list), _holes(root, walk.bodies)
    for a, b in pairs:
        held[a].append(known[b])
        held[b].append(known[a])
    for mass in walk.bodies:
        path = mass.structure.path
        if path not in free and mass.section.num_contour() > 1:
            yield from _cut_free(walk, mass, holes.get(path, ()), held[path])


def _faces(walk: Bodies, structures: Iterable[SolvedStructure]) -> list[OwnFace]:
    return [face for s in structures for face in walk.faces.get(s.path, ())]


def _pieces(walk: Bodies, mass: Mass) -> list[_Piece]:
    """Returns the pieces that a solid covers before anything is cut out; none if they are all alike."""
    faces = _faces(walk, _material(mass.structure))
    if len(faces) < 2:
        return []
    sections = union([*(f.section for f in faces), *(v.section for v in mass.voids)]).decompose()
    if len({_area(section) for section in sections}) < 2:
        return []  # one, or all alike
    of: list[list[OwnFace]] = [[] for _ in sections]
    count = len(sections)
    for i, j in sorted(near_pairs([s.box for s in (*sections, *(f.section for f in faces))], 0.0)):
        if i < count <= j and sections[i].overlaps(faces[j - count].section):
            of[i].append(faces[j - count])
    traced(sections)  # all at once
    # What no face overlaps is a hole beside the material.
    return [_Piece(section, tuple(own)) for section, own in zip(sections, of, strict=True) if own]


def _material(structure: SolvedStructure) -> Iterator[SolvedStructure]:
    yield structure
    for child in structure.structures:
        if child.kind in ("solid", "assembly"):
            yield from _material(child)


def _area(section: Section) -> str:
    """Returns an area with six digits, so that pieces of one size compare equal."""
    return f"{section.area:.6g}"


def _groups(
    pieces: Sequence[_Piece], own: Solid, known: dict[str, Solid], pairs: Sequence[tuple[str, str]]
) -> list[list[_Piece]]:
    """Returns groups of pieces that hold together, directly or by other bodies; the largest group first."""
    joined = Joined()
    for pair in pairs:
        if own.path not in pair:
            joined.join(*pair)
            continue
        other = known[pair[pair[0] == own.path]]
        for number, piece in enumerate(pieces):
            if _meet(piece.section, other.section):
                joined.join(number, other.path)
    for i, j in near_pairs([piece.section.region.box for piece in pieces], UNNOTICED):
        if lie_within(pieces[i].section.region, pieces[j].section.region, UNNOTICED):
            joined.join(i, j)
    of: dict[int, int] = {}
    for number, piece in enumerate(pieces):
        for face in piece.faces:
            joined.join(number, of.setdefault(id(face), number))
    groups = [[pieces[k] for k in group] for group in joined.groups(range(len(pieces)))]
    return sorted(groups, key=lambda group: -sum(p.section.area for p in group))


def _notes(solid: SolvedStructure, groups: Sequence[Sequence[_Piece]]) -> Iterator[Diagnostic]:
    alike = Counter(trait for group in groups for piece in group for trait in _traits(piece))

    def is_meant(piece: _Piece) -> bool:
        lettering = all(g.type == LETTERING for f in piece.faces for g in f.geometries)
        return lettering or any(alike[trait] >= _PATTERN for trait in _traits(piece))

    loose = [group for group in groups[1:] if not all(map(is_meant, group))]
    for group in loose[:_MOST]:
        yield _note(solid, group, [piece for other in groups if other is not group for piece in other])


def _traits(piece: _Piece) -> Iterator[object]:
    """Yields what makes pieces alike: their area, and the statement, in a loop, that makes them."""
    yield _area(piece.section)
    yield from {g.span for f in piece.faces for g in f.geometries if g.span}


def _note(solid: SolvedStructure, group: Sequence[_Piece], rest: Sequence[_Piece]) -> Diagnostic:
    gap, place = nearest_region([p.section.region for p in group], [p.section.region for p in rest])
    nearest = rest[place]
    names, beside = _names(solid, group), _names(solid, [nearest])
    first = group[0].faces[0].geometries[0]
    touches = "touch" if len(names) > 1 else "touches"
    return Diagnostic(
        "W0712",
        f"{named(names)} {touches} nothing else of solid `{solid.path}`; the nearest, {named(beside)}, "
        f"{'are' if len(beside) > 1 else 'is'} {rough(gap)} mm away",
        first.span or solid.span,
        "a piece of its own",
        hints=(
            "to join them, let them meet: end one on the other, or say `gap: 0`, `touching(…)`",
            "if they are parts of their own, make each a `solid`",
            f"if the gap is meant, say so: `@detached` before `{solid.name}`",
        ),
    )


# --- Cut free ------------------------------------------------------------------------------------


def _cut_free(
    walk: Bodies, mass: Mass, holes: Sequence[SolvedStructure], others: Sequence[Solid]
) -> Iterator[Diagnostic]:
    """Yields the warnings on pieces that holes cut off a body, and that neither it nor others hold."""
    islands = union_of(_faces(walk, _islands(mass.structure)))
    yield from _severed(walk, mass, holes, others, islands)
    if mass.section.num_contour() < _RING:
        return
    loose: dict[str, tuple[SolvedStructure, list[Section], dict[str, None]]] = {}
    for piece, gap in _enclosed(mass.section.decompose()):
        if piece.overlaps(islands):
            continue  # put there on purpose
        if _was_joined(walk, mass, piece, gap) and not _touches(piece, others):
            for hole, around in _cutting(walk, holes, gap, piece):
                _, pieces, names = loose.setdefault(hole.path, (hole, [], {}))
                pieces.append(piece)
                names.update(around)
    for fallen in loose.values():
        yield _fallen(mass.structure, walk, *fallen)


def _severed(
    walk: Bodies, mass: Mass, holes: Sequence[SolvedStructure], others: Sequence[Solid], islands: Section
) -> Iterator[Diagnostic]:
    """Yields the warning that holes leave a solid in pieces beside one another which were one before, and of
    which nothing else holds those that are not the largest.
    """
    holes = [hole for hole in holes if hole.path in walk.sections]
    if not holes:
        return
    pieces = sorted(mass.section.decompose(), key=lambda piece: -piece.area)
    enclosed = {id(piece) for piece, _ in _enclosed(pieces)}
    beside = [p for p in pieces if id(p) not in enclosed and not p.overlaps(islands)]
    for whole in union_of(_faces(walk, _material(mass.structure))).decompose():
        parts = [piece for piece in beside if whole.covers(piece)]
        apart = [piece for piece in parts[1:] if not _touches(piece, others)]
        # Those with which filled again pieces would hang together.
        filled = ((h, union([walk.sections[h.path], *parts])) for h in holes if apart)
        cut = [h for h, whole in filled if len(whole.decompose()) < len(parts)]
        if cut:
            yield _cut_through(mass.structure, cut, [parts[0], *apart])


def _cut_through(
    solid: SolvedStructure, holes: Sequence[SolvedStructure], pieces: Sequence[Section]
) -> Diagnostic:
    boxes = [region.box for region in traced(pieces)]
    sizes = [f"{rough(b[2] - b[0])} × {rough(b[3] - b[1])} mm" for b in boxes[:_MOST]]
    more = f" and {len(boxes) - _MOST} more" if len(boxes) > _MOST else ""
    first = holes[0]
    return Diagnostic(
        "W0762",
        f"{solid.kind} `{solid.path}` falls into {len(pieces)} pieces: "
        f"{named([hole.path for hole in holes], _MOST)} {'cuts' if len(holes) == 1 else 'cut'} through it",
        first.span or solid.span,
        f"what is left measures {', '.join(sizes)}{more}",
        hints=(
            f"end `{first.name}` within the material, or leave a bridge: a `solid` in `{first.name}` stays",
            "if they are parts of their own, make each a `solid`",
            f"if that is meant, say so: `@detached` before `{solid.name}`",
        ),
    )


def _islands(structure: SolvedStructure) -> Iterator[SolvedStructure]:
    """Yields the structures in the holes of one."""
    for each in structure.walk():
        if each.kind == "hole":
            yield from (s for child in each.structures if child.kind != "hole" for s in _material(child))


def _holes(root: SolvedStructure, masses: Sequence[Mass]) -> dict[str, list[SolvedStructure]]:
    """Returns for each body the holes that may cut it: its own, and those of the structures around it."""
    found: dict[str, list[SolvedStructure]] = {mass.structure.path: [] for mass in masses}

    def visit(structure: SolvedStructure, around: Sequence[SolvedStructure]) -> None:
        within = [*around, *(child for child in structure.structures if child.kind == "hole")]
        if structure.path in found:
            deeper = (inner for child in structure.structures for inner in child.structures)
            found[structure.path] = [*within, *(s for d in deeper for s in d.walk() if s.kind == "hole")]
        for child in structure.structures:
            visit(child, within)

    visit(root, [])
    return found


def _enclosed(sections: Sequence[Section]) -> Iterator[tuple[Section, Section]]:
    """Yields the pieces that lie in openings of others, each with the smallest such opening."""
    if len(sections) < 2:
        return
    openings = [hole for s in sections if s.num_contour() > 1 for hole in s.holes()]
    count, around = len(sections), dict[int, Section]()
    for i, j in near_pairs([s.box for s in (*sections, *openings)], 0.0):
        if not i < count <= j or not (opening := openings[j - count]).covers(sections[i]):
            continue
        if i not in around or opening.area < around[i].area:
            around[i] = opening
    yield from ((sections[i], around[i]) for i in sorted(around))


def _was_joined(walk: Bodies, mass: Mass, piece: Section, opening: Section) -> bool:
    """Tells whether a piece was part of the material around the opening before the cuts."""
    faces = (face.section for face in _faces(walk, _material(mass.structure)))
    near = union([f for f in faces if f.may_meet(opening)])
    return any(whole.covers(opening) and whole.covers(piece) for whole in near.decompose())


def _touches(piece: Section, others: Sequence[Solid]) -> bool:
    return any(_meet(piece, other.section) for other in others)


def _cutting(
    walk: Bodies, holes: Iterable[SolvedStructure], opening: Section, piece: Section
) -> Iterator[tuple[SolvedStructure, dict[str, None]]]:
    """Yields the holes that took what was around a piece, and the names of their geometries."""
    between = opening - piece
    for hole in holes:
        faces = [f for f in walk.faces.get(hole.path, ()) if f.section.overlaps(between)]
        if faces:
            yield hole, {g.name: None for f in faces for g in f.geometries}


def _fallen(
    solid: SolvedStructure,
    walk: Bodies,
    hole: SolvedStructure,
    pieces: Sequence[Section],
    around: Iterable[str],
) -> Diagnostic:
    """Returns the warning on pieces that a hole cuts free; `around`: the names of its geometries there."""
    count, largest = len(pieces), max(pieces, key=lambda piece: piece.area)
    left, bottom, right, top = largest.region.box
    size = f"{rough(right - left)} × {rough(top - bottom)} mm"
    cuts = [g for f in walk.faces[hole.path] for g in f.geometries]
    fall = "a piece falls" if count == 1 else f"{count} pieces fall"
    hints = [f"leave a bridge: a `solid` in `{hole.name}` stays, so one across the gap holds the piece"]
    fix = None
    if all(g.type == LETTERING for g in cuts):
        hints[0] = "`stencil: true` in a text gives its letters bridges"
        hints.insert(0, "to write on it in place of cutting through, make it a `drawing`")
        fix = _stencil_fix({g.span for g in cuts if g.span is not None})
    hints.append(f"if that is meant, say so: `@detached` before `{solid.name}`")
    return Diagnostic(
        "W0714",
        f"{fall} out of {solid.kind} `{solid.path}`: hole `{hole.path}` cuts all around "
        f"{'it' if count == 1 else 'them'}",
        hole.span or solid.span,
        f"nothing holds what is inside {named(around)}: "
        f"{size if count == 1 else f'{count} pieces, the largest {size}'}",
        hints=tuple(hints),
        fix=fix,
    )


def _stencil_fix(texts: set[Span]) -> Fix | None:
    """Returns the fix that makes texts those of a stencil; None where one ends with more than its call."""
    if any(re.search(r"\)\s*(at|rotated)\b|[^)]$", span.text) for span in texts):
        return None
    ends = sorted((Span(span.source, span.end - 1, span.end) for span in texts), key=lambda end: end.start)
    return Fix("bridge the letters: `stencil: true`", tuple(Edit(end, ", stencil: true)") for end in ends))


def _names(solid: SolvedStructure, pieces: Iterable[_Piece]) -> list[str]:
    found = [g.path.removeprefix(f"{solid.path}.") for p in pieces for f in p.faces for g in f.geometries]
    return list(dict.fromkeys(found))
