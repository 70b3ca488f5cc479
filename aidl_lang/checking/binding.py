"""The choice of an overload for a call, and synonyms of arguments and members."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TypeAlias

from aidl_lang.checking.types import (
    AnyType,
    ArgumentSource,
    Binding,
    Given,
    GivenArgument,
    ListType,
    Mismatch,
    NumberType,
    PointType,
    Signature,
    TruthType,
    Type,
    accepts,
    bind,
)
from aidl_lang.checking.units import LENGTH
from aidl_lang.common.names import fold
from aidl_lang.common.prose import ticked

# --- Synonyms of arguments and members, in tables for the checker, the interpreter and the printer.
#
# They are consulted only if no overload, or no member, is spelled as written (case and underscores aside).
# In `MEMBERS` a word stands for the first of its meanings that is there; in `PARAMETERS` it has to be the
# only one that is there and not given otherwise, else the call is ambiguous.

_PARAMETERS = """
radius: r rad
r: radius
outer_radius inner_radius: radius r rad r1 r2 radius1 radius2
outer_radius: r_outer r_out ro r_o outer outer_r radius_outer outside_radius major_radius max_radius
inner_radius: r_inner r_in ri r_i inner inner_r radius_inner inside_radius minor_radius min_radius
diameter: d dia diam
d: diameter dia distance amount by
outer_diameter inner_diameter: d dia diameter
outer_diameter: od d_outer outer_d outer_dia outside_diameter diameter_outer
inner_diameter: id d_inner inner_d inner_dia inside_diameter diameter_inner bore
width: w wide
w: width
height: h tall
h: height
width height: thickness thick
size: side side_length edge edge_length a s
bottom_width: bottom base base_width width_bottom bottom_length
top_width: top width_top top_length
base: b width base_width
thickness: t thick wall wall_thickness border
radius: circumradius
inradius: apothem inner_radius
side: s edge edge_length side_length
across_flats: flat_to_flat flats af
bottom_left: lower_left left_bottom bl min corner
bottom_right: lower_right right_bottom br
top_left: upper_left left_top tl
top_right: upper_right right_top tr max
top_center: top top_middle top_mid middle_top mid_top
bottom_center: bottom bottom_middle bottom_mid middle_bottom mid_bottom
left_center: left left_middle left_mid middle_left mid_left
right_center: right right_middle right_mid middle_right mid_right
left: min_x x_min xmin minx
right: max_x x_max xmax maxx
bottom: min_y y_min ymin miny
top: max_y y_max ymax maxy
rx: x_radius radius_x r_x semi_major a
ry: y_radius radius_y r_y semi_minor b
center: centre ctr c middle pos position at loc location
at: position pos location
start: p1 from start_point begin first p_start pt1 point1 a
end: p2 p3 to end_point stop last p_end pt2 point2 b
mid: middle through via p2 point_on
p0: start from
p1: control1 c1 start_control
p2: control2 c2 end_control
p3: end to
from: start start_point begin
angle: rot rotation theta orientation tilt phi deg degrees
start_angle: start a1 angle1 from_angle begin_angle from
end_angle: end a2 angle2 to_angle stop_angle to
length: len l overall_length total_length
distance: d by amount offset
gap: spacing distance space by separation offset
at_least: min_gap minimum min min_distance
gap at_least: clearance margin
margin: padding clearance inset border gap offset
inset: offset margin
spacing: gap pitch
pitch: spacing gap
sides: n count num number number_of_sides side_count num_sides n_sides
teeth: n count num number number_of_teeth num_teeth n_teeth tooth_count z
points: n count num number number_of_points num_points n_points point_count tips
n: count num number times copies
count: n num number times copies
points: vertices verts corners pts coords coordinates
corner_radius: r radius rounding fillet
radius: corner_radius fillet rounding corner corner_r fillet_radius rounding_radius
module: m mod
pressure_angle: pa alpha
axis: direction dir along
align: alignment justify anchor halign text_anchor
height: size font_size text_size letter_height cap_height
text: string label content message caption
line_spacing: leading line_height
about: axis across mirror_line line
value: v amount equals distance length angle theta degrees deg
clockwise: cw
ccw: counterclockwise anticlockwise
inside: internal
large: large_arc
"""
"""`meanings: words`; a word in several lines has all their meanings."""

_MEMBERS = """
radius: r rad
diameter: d dia diam
center: centre ctr c middle mid position pos origin
midpoint: mid middle mid_point center_point
width: w
height: h
start: p1 from start_point begin first
end: p2 to end_point stop last
p1: control1 c1
p2: control2 c2
length: len
angle: rot rotation theta rotate orientation tilt
rx: x_radius radius_x
ry: y_radius radius_y
sweep: sweep_angle angle
center_x: cx x_center mid_x
center_y: cy y_center mid_y
left: min_x x_min xmin minx left_x left_edge
right: max_x x_max xmax maxx right_x right_edge
bottom: min_y y_min ymin miny bottom_y bottom_edge
top: max_y y_max ymax maxy top_y top_edge
bottom_left: min lower_left bl left_bottom
bottom_right: lower_right br right_bottom
top_left: upper_left tl left_top
top_right: max upper_right tr right_top
top_center: top_mid top_middle center_top mid_top
bottom_center: bottom_mid bottom_middle center_bottom mid_bottom
left_center: left_mid left_middle center_left mid_left
right_center: right_mid right_middle center_right mid_right
corner: vertices vertex corners
corner: points
"""


def _read(table: str) -> Mapping[str, tuple[str, ...]]:
    """Returns folded word → its meanings, in the order of the lines."""
    found: dict[str, dict[str, None]] = {}
    for line in table.strip().splitlines():
        meanings, _, words = line.partition(": ")
        for word in words.split():
            found.setdefault(fold(word), {}).update(dict.fromkeys(meanings.split()))
    return {word: tuple(meanings) for word, meanings in found.items()}


PARAMETERS = _read(_PARAMETERS)
MEMBERS = _read(_MEMBERS)

FIELDS = frozenset(MEMBERS) | {fold(m) for meanings in MEMBERS.values() for m in meanings}
"""All words that may name a field, folded."""

PAIRS: Mapping[str, tuple[str, str]] = {
    "size": ("width", "height"),
    "dimensions": ("width", "height"),
    "dims": ("width", "height"),
    "radii": ("rx", "ry"),
}
"""An argument of two numbers that stands for two parameters: `size: (40, 20)`."""

COORDINATES: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("x", "y", ("center", "at")),
    ("cx", "cy", ("center",)),
    ("centerx", "centery", ("center",)),
    ("x1", "y1", ("start",)),
    ("x2", "y2", ("end",)),
)
"""Two folded names that together give one point, and the parameters it may be."""


# --- The choice of an overload for a call: arguments are read as they are written first, then in other
# words.
#
# In other words means: an argument by a synonym of its parameter's name (`r` for `radius`), two parameters
# by one pair (`size: (40, 20)`), a point by its coordinates (`x: 3, y: 4`), sizes by their order without the
# centre before them (`circle(5)`) or behind what is named (`rectangle(bottom_center: p, 20, 10)`).

Outcomes: TypeAlias = Sequence[Binding | Mismatch]

_MOST_KEPT = 16  # arguments of a call whose outcomes are cached: hardly any has more, and those take memory


def outcomes(candidates: Sequence[Signature], given: Given) -> Outcomes:
    """Returns the candidates that fit, perhaps beside mismatches, or else a mismatch for each. Arguments are
    read in other words only if none takes them as written. The author's own definitions come before the
    standard ones of that name.
    """
    if len(given) <= _MOST_KEPT and all(candidate.standard for candidate in candidates):
        return _of_standard(tuple(candidates), tuple(given))
    return _outcomes(candidates, given)


@lru_cache(maxsize=8192)
def _of_standard(candidates: tuple[Signature, ...], given: tuple[GivenArgument, ...]) -> Outcomes:
    """Returns the outcomes for standard definitions, which are the same in every program."""
    return tuple(_outcomes(candidates, given))


def _outcomes(candidates: Sequence[Signature], given: Given) -> Outcomes:
    words = {fold(g.name) for g in given if g.name is not None}
    positional = sum(g.name is None for g in given)
    own = [candidate for candidate in candidates if not candidate.standard]
    choices = [own, candidates] if 0 < len(own) < len(candidates) else [candidates]
    for among in choices:
        plain = [bind(c, given) for c in among if c.may_take(positional, words)]
        if any(isinstance(outcome, Binding) for outcome in plain):
            return plain
    named = [i for i, g in enumerate(given) if g.name is not None]
    for among in choices:
        loose = [_loosely(candidate, given) for candidate in among]
        if fits := _agreeing(loose, given, named):
            return fits
    if following := _following(given):
        for among in choices:
            filled = [_filling(candidate, given, following) for candidate in among]
            if fits := _agreeing(filled, given, following):
                return fits
    return loose


def select(candidates: Sequence[Signature], given: Given) -> Binding | list[Mismatch]:
    """Returns the candidate that fits best (least conversion, then fewest bare numbers for an angle that may
    be left out, then fewest defaults, then first written), or all mismatches.
    """
    found = outcomes(candidates, given)
    fits = [outcome for outcome in found if isinstance(outcome, Binding)]
    return min(fits, key=lambda b: b.cost) if fits else [o for o in found if isinstance(o, Mismatch)]


def _agreeing(found: Outcomes, given: Given, asked: Iterable[int]) -> list[Binding | Mismatch]:
    """Returns the candidates that fit; a mismatch if one of the arguments `asked` for is one parameter here
    and another there, and does not say which by its name.
    """
    fits = [outcome for outcome in found if isinstance(outcome, Binding)]
    for index in asked:
        word = given[index].name
        meant = list(dict.fromkeys(n for fit in fits if (n := fit.parameter_of(index)) is not None))
        is_said = word is not None and fold(word) in map(fold, meant)
        if len(meant) > 1 and not is_said and not isinstance(given[index].type, AnyType):
            return [_ambiguous(fit.signature, word, meant, index) for fit in fits]
    return list(fits)


def in_order(candidates: Sequence[Signature], given: Given) -> Mapping[int, str]:
    """Returns the parameters that the arguments without a name would fill, by their index, if they all went
    to parameters that are not named; none if no candidate takes them so, or candidates differ about it.
    """
    loose = [i for i, g in enumerate(given) if g.name is None]
    fits = [b for c in candidates if isinstance(b := _filling(c, given, loose), Binding)]
    found = {tuple((i, fit.parameter_of(i)) for i in loose) for fit in fits}
    return {i: name for i, name in found.pop() if name is not None} if len(found) == 1 else {}


def _following(given: Given) -> Sequence[int]:
    first = next((i for i, g in enumerate(given) if g.name is not None), len(given))
    return [i for i in range(first, len(given)) if given[i].name is None]


def _filling(signature: Signature, given: Given, following: Sequence[int]) -> Binding | Mismatch:
    """Matches some arguments without a name to the parameters that nothing else fills, in their order;
    without a centre that may be left out if they do not begin with it.
    """
    read = [(replace(g), ArgumentSource(i)) for i, g in enumerate(given) if i not in following]
    renamed = _renamed(signature, read)
    if isinstance(renamed, Mismatch) or signature.gathers or signature.takes_any:
        return Mismatch(signature, "does not fit")
    names = [name for name, _, _ in signature.parameters]
    leading = sum(g.name is None for g, _ in renamed)
    filled = {*names[:leading], *(signature.by_fold.get(fold(g.name)) for g, _ in renamed if g.name)}
    free = [name for name in names if name not in filled]
    center = _center(signature)
    choices = [free, free[1:]] if free and free[0] == center else [free]
    outcome: Binding | Mismatch = Mismatch(signature, "does not fit")
    for choice in choices:
        if len(choice) < len(following):
            break
        pairs = zip(following, choice, strict=False)
        late = [(replace(given[i], name=name), ArgumentSource(i)) for i, name in pairs]
        outcome = _bound(signature, [*renamed, *late])
        if isinstance(outcome, Binding):
            break
    return outcome


def _ambiguous(signature: Signature, word: str | None, meant: Sequence[str], index: int) -> Mismatch:
    by, names = f" by `{word}`" if word is not None else "", " or ".join(ticked(meant))
    return Mismatch(signature, f"does not tell{by} whether {names} is meant", index, tuple(meant))


def _loosely(signature: Signature, given: Given) -> Binding | Mismatch:
    """Matches arguments to the parameters of one callable in other words than theirs."""
    read = [(replace(g), ArgumentSource(i)) for i, g in enumerate(given)]
    read = _without_flag(signature, read)
    read = _joined(signature, read)
    read = _split(signature, read)
    renamed = _renamed(signature, read)
    if isinstance(renamed, Mismatch):
        return renamed
    outcome = _bound(signature, renamed)
    if isinstance(outcome, Mismatch) and (named := _after_center(signature, renamed)) is not None:
        skipped = _bound(signature, named)
        if isinstance(skipped, Binding) or all(not g.name for g in given):
            outcome = skipped
    return outcome


_Read = list[tuple[GivenArgument, ArgumentSource]]


def _bound(signature: Signature, read: _Read) -> Binding | Mismatch:
    outcome = bind(signature, [g for g, _ in read])
    sources = tuple(source for _, source in read)
    if isinstance(outcome, Binding):
        return replace(outcome, sources=sources)
    if outcome.argument is not None:
        return replace(outcome, argument=sources[outcome.argument].index)
    return outcome


def _center(signature: Signature) -> str | None:
    """Returns the name of the first parameter if it is a centre that may be left out."""
    if not signature.parameters:
        return None
    name, kind, optional = signature.parameters[0]
    return name if optional and isinstance(kind, PointType) and fold(name) == "center" else None


def _without_flag(signature: Signature, read: _Read) -> _Read:
    """Drops `center: true`, which asks for the default: a place about the centre."""
    center = _center(signature)
    return [
        (g, source)
        for g, source in read
        if not (center and g.name and isinstance(g.type, TruthType) and _means(g.name, center))
    ]


def _means(word: str, parameter: str) -> bool:
    return fold(word) == fold(parameter) or parameter in PARAMETERS.get(fold(word), ())


def _joined(signature: Signature, read: _Read) -> _Read:
    for x, y, meanings in COORDINATES:
        target = next((m for m in meanings if m in signature.by_fold), None)
        found = {fold(g.name): (g, s) for g, s in read if g.name and fold(g.name) not in signature.by_fold}
        if target is None or x not in found or y not in found:
            continue
        pair = found[x], found[y]
        if all(accepts(NumberType(LENGTH), g.type) is not None for g, _ in pair):
            source = ArgumentSource(pair[0][1].index, other=pair[1][1].index)
            point = GivenArgument(target, PointType()), source
            read = [one for one in read if one not in pair] + [point]
    return read


def _split(signature: Signature, read: _Read) -> _Read:
    """Turns a pair into the two parameters it stands for."""
    result: _Read = []
    for g, source in read:
        word = fold(g.name) if g.name else ""
        targets = PAIRS.get(word) if word not in signature.by_fold else None
        parts = _parts(g.type)
        if targets is None or parts is None or not all(t in signature.by_fold for t in targets):
            result.append((g, source))
            continue
        result += [(GivenArgument(t, parts), replace(source, part=i)) for i, t in enumerate(targets)]
    return result


def _parts(kind: Type) -> Type | None:
    """Returns the type of the two parts of a pair; None if it is no pair."""
    match kind:
        case PointType():
            return NumberType(LENGTH)
        case ListType(element, 2) if isinstance(element, NumberType | AnyType):
            return element
        case _:
            return None


def _renamed(signature: Signature, read: _Read) -> _Read | Mismatch:
    """Turns synonyms into the names of the parameters they can only mean."""
    taken = {signature.by_fold[fold(g.name)] for g, _ in read if g.name and fold(g.name) in signature.by_fold}
    positional = sum(1 for g, _ in read if g.name is None)
    if not signature.gathers:
        taken |= {name for name, _, _ in signature.parameters[:positional]}
    open_words = {g.name for g, _ in read if g.name and fold(g.name) not in signature.by_fold}
    known: dict[str, str] = {}
    while open_words:
        choices = {w: _meanings(signature, w, taken) for w in open_words}
        settled = {w: names[0] for w, names in choices.items() if len(names) == 1}
        if not settled:
            break
        known |= settled
        taken |= set(settled.values())
        open_words -= settled.keys()
    for g, source in read:
        meant = _meanings(signature, g.name, taken) if g.name in open_words and g.name else []
        if len(meant) > 1:
            return _ambiguous(signature, g.name, meant, source.index)
    return [(replace(g, name=known.get(g.name or "", g.name)), source) for g, source in read]


def _meanings(signature: Signature, word: str, taken: set[str]) -> list[str]:
    known: Mapping[str, str] = signature.by_fold
    found = (known[m] for meaning in PARAMETERS.get(fold(word), ()) if (m := fold(meaning)) in known)
    return [name for name in found if name not in taken]


def _after_center(signature: Signature, read: _Read) -> _Read | None:
    """Gives positional sizes to the parameters behind the centre; counts have to be named."""
    positional = [i for i, (g, _) in enumerate(read) if g.name is None]
    following = signature.parameters[1 : len(positional) + 1]
    if _center(signature) is None or not positional or len(following) < len(positional):
        return None
    if not all(isinstance(kind, NumberType) and not kind.whole for _, kind, _ in following):
        return None
    names = dict(zip(positional, (name for name, _, _ in following), strict=True))
    return [(replace(g, name=names.get(i, g.name)), source) for i, (g, source) in enumerate(read)]
