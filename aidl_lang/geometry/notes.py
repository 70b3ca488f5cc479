"""Diagnostics on the findings of this package, with places, reasons and remedies."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import combinations, islice

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import counted, named, rough, ticked
from aidl_lang.common.source import Span
from aidl_lang.geometry.bodies import AGAIN, Covered, End, Finding, Gap, LooseCurves, ends_of, label
from aidl_lang.geometry.curves import LARGEST, NO_LENGTH, Bezier, Vec, larger_side
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure, at

GUIDE = "to guide other geometry only, write `construction` before it"


def local(structure: SolvedStructure, geometry: SolvedGeometry) -> str:
    """Returns the name of a geometry as the structure writes it."""
    return geometry.path.removeprefix(structure.path + ".")


def _inner_loop(finding: Covered) -> Diagnostic:
    s, face = finding.structure, finding.face
    names = [local(s, g) for g in face.geometries]
    around = [local(s, g) for g in finding.by]
    one = len(set(names)) == 1
    kind = "" if s.kind == "solid" else f"{s.kind} "
    hole = f"hole {_fresh(s, names[0])} {{ {names[0]} = … }}"
    return Diagnostic(
        "W0701",
        f"{named(names)} {'lies' if one else 'lie'} inside {named(around)} and "
        f"{'adds' if one else 'add'} nothing to {kind}`{s.path}`",
        face.geometries[0].span or s.span,
        "faces of one structure are united",
        tuple(Label(g.span, "already covers it") for g in finding.by[:2] if g.span),
        (
            f"to cut it out, put it into a hole: `{hole}`",
            f'to draw it on top, give it a look of its own, as `@color("gold")` before it, or put it into a '
            f"`drawing`; {GUIDE}",
        ),
        _wrap_fix(s, face.geometries) if one else None,
    )


def _fresh(structure: SolvedStructure, name: str) -> str:
    """Returns a name for a hole around a geometry that its structure does not use yet."""
    base = re.sub(r"\W.*", "", name) + "_hole"
    if structure.span and base not in _words(structure.span.source.text):
        return base
    taken = {g.name for g in structure.geometry} | {c.name for c in structure.structures}
    return next(n for n in (base, *(f"{base}{k}" for k in range(2, 99))) if n not in taken)


@lru_cache(maxsize=4)
def _words(text: str) -> Counter[str]:
    return Counter(re.findall(r"\w+", text))


def _wrap_fix(structure: SolvedStructure, geometries: Sequence[SolvedGeometry]) -> Fix | None:
    """Returns the fix that makes the definition a hole; None if anything else refers to it."""
    geometry = geometries[0]
    span = geometry.span
    if span is None or not re.fullmatch(rf"{re.escape(geometry.name)}\s*=\s*\w+\(.*\)", span.text, re.DOTALL):
        return None
    spoken = set(re.findall(r"[^\W\d]\w*(?!\s*[:=(\w])", span.text.partition("=")[2]))
    within = re.findall(rf"\b{re.escape(geometry.name)}\b", span.text)
    elsewhere = _words(span.source.text)[geometry.name] > len(within)
    if elsewhere or (spoken and any(g.name in spoken for g in (geometry, *structure.geometry))):
        return None
    hole = f"hole {_fresh(structure, geometry.name)} {{ {span.text} }}"
    return Fix(f"make `{geometry.name}` a hole", (Edit(span, hole),))


def upright_note(hole: SolvedStructure) -> Diagnostic:
    return Diagnostic(
        "W0760",
        f"`{hole.path}` is to narrow as a cone, and is no circle: its walls stand upright",
        hole.span,
        hints=("leave the angle of `@depth` out, or draw one circle in a hole of its own",),
    )


def _loose_curves(finding: LooseCurves, network: Network) -> Diagnostic:
    s = finding.structure
    names = _whole_names(s, [g for g, _ in finding.curves])
    gap, own = _gap(finding, network), {g.path for g, _ in finding.curves}
    plural = len(set(names)) > 1
    message = f"{named(names)} {'enclose' if plural else 'encloses'} nothing in {s.kind} `{s.path}`"
    if gap is not None and math.dist(gap[0].at, gap[1].at) <= network.tolerance:
        return _lost(finding, message, network)
    hints = [f"to draw without filling, use a `drawing`; {GUIDE}"]
    fix: Fix | None = None
    secondary: tuple[Label, ...] = ()
    if gap is not None:
        (p, q), other = (end.at for end in gap), gap[1].geometry
        message += f": the end at {at(p)} is {rough(math.dist(p, q))} mm away from {at(q)}"
        if gap[0].geometry is not other:
            equation = " == ".join(_end(s, end) for end in gap)
            hints.insert(0, f"join the ends: `constrain {equation}`")
            fix = _join_fix(s, equation)
            secondary = (Label(other.span, f"the nearest other end, at {at(q)}"),) if other.span else ()
        else:
            hints.insert(0, "close the outline: draw the missing curve, sharing the end points")
    elif shape := next((g for g in s.geometry if own < set(_primitive_paths(g))), None):  # others close it
        hints.insert(0, f"its strokes become material with a width, as in `thick({shape.type}(…), 1.2)`")
    else:
        hints.insert(0, "a face needs a closed outline that is not flat: look at its sizes and its points")
    span = gap[0].geometry.span if gap else finding.curves[0][0].span
    return Diagnostic(
        "W0702",
        message,
        span or s.span,
        "its end is open" if gap else "",
        secondary,
        tuple(hints),
        fix,
        tuple(end.at for end in gap or ()),
    )


def _lost(finding: LooseCurves, message: str, network: Network) -> Diagnostic:
    """Returns the diagnostic on curves too small for the drawing: their ends are as good as one point."""
    return Diagnostic(
        "W0702",
        f"{message}: too small beside the drawing, which measures {rough(network.size)} mm",
        finding.curves[0][0].span or finding.structure.span,
        "lost in it",
        hints=("look for a size or position that was written in another unit, or changed without bounds",),
    )


def _whole_names(structure: SolvedStructure, loose: Sequence[SolvedGeometry]) -> list[str]:
    """Returns the names of these primitives, a compound shape by its own where none of it bounds a face."""
    found = {g.path for g in loose}
    whole = {
        curve: geometry.name
        for geometry in structure.geometry
        if (curves := _primitive_paths(geometry)) and found.issuperset(curves)
        for curve in curves
    }
    return list(dict.fromkeys(whole.get(g.path, local(structure, g)) for g in loose))


def _primitive_paths(geometry: SolvedGeometry) -> list[str]:
    is_seen = (
        geometry.curve is not None
        and not geometry.construction
        and not larger_side(geometry.curve.box) < NO_LENGTH
    )
    own = [geometry.path] if is_seen else []
    return own + [path for part in geometry.parts for path in _primitive_paths(part)]


def _gap(finding: LooseCurves, network: Network) -> tuple[End, End] | None:
    """Returns the open end that is nearest to another one, ends of one curve only if there are no others."""
    meeting = network.meeting(finding.numbers)
    every = (end for geometry, number in finding.curves for end in ends_of(network, geometry, number))
    pairs = combinations((end for end in every if meeting[network.node(end.at)] <= 1), 2)
    return min(
        pairs, key=lambda ab: (ab[0].geometry is ab[1].geometry, math.dist(ab[0].at, ab[1].at)), default=None
    )


def _end(structure: SolvedStructure, end: End) -> str:
    geometry, name = end.geometry, "end" if end.is_last else "start"
    if geometry.piece_of:
        # Of an imported drawing the shape that it belongs to is told as well, which stands between the two.
        shape = geometry.path.removeprefix(geometry.piece_of).rpartition(".")[0].partition("[")[0]
        return f"{geometry.piece_of.removeprefix(structure.path + '.')}{shape}.{name}"
    if isinstance(geometry.curve, Bezier):
        name = "p3" if end.is_last else "p0"
    return f"{local(structure, geometry)}.{name}"


def gap_note(gap: Gap) -> Diagnostic:
    """Returns the note that two ends which do not quite meet were taken for one."""
    s = gap.structure
    moved, kept = gap.moved, gap.kept
    one, other = _end(s, moved), _end(s, kept)
    name, itself = local(s, moved.geometry), moved.number == kept.number
    round_ = itself and not isinstance(moved.geometry.curve, Bezier)
    hint = (
        f"to close it exactly, write a `circle` in place of `{name}`"
        if round_
        else f"to let them meet exactly: `constrain {one} == {other}`"
    )
    return Diagnostic(
        "N0708",
        f"a gap of {rough(gap.width)} mm between `{one}` and `{other}` at {at(kept.at)} was closed "
        f"in {s.kind} `{s.path}`",
        moved.geometry.span or s.span,
        "its end was moved",
        (Label(kept.geometry.span, "to this end"),) if kept.geometry.span and not itself else (),
        (hint,),
        None if round_ else _join_fix(s, f"{one} == {other}"),
        (moved.at, kept.at),
    )


def _join_fix(structure: SolvedStructure, equation: str) -> Fix | None:
    span = structure.span
    if span is None or not span.text.endswith("}"):
        return None
    place = Span(span.source, span.end - 1, span.end - 1)
    line = span.source.line(span.source.position(span.end - 1)[0])
    own_line = line.strip() == "}"
    indent = line[: len(line) - len(line.lstrip())]
    text = f"    constrain {equation}\n{indent}" if own_line else f"; constrain {equation} "
    return Fix("join the two ends", (Edit(place, text),))


def _covered_holes(finding: Covered) -> Diagnostic:
    s, count = finding.structure, finding.holes
    face, by = named([local(s, g) for g in finding.face.geometries]), [local(s, g) for g in finding.by]
    holes = f"{count} holes of {face} are" if count > 1 else f"a hole of {face} is"
    return Diagnostic(
        "W0708",
        f"{holes} filled again by {named(by)} in {s.kind} `{s.path}`",
        finding.face.geometries[0].span or s.span,
        "faces of one structure are united",
        tuple(Label(g.span, "covers what it leaves open") for g in finding.by[:2] if g.span),
        (
            f"if {named(by)} shall only guide other geometry, write `construction` before it",
            f"to cut both, unite them before: `cut(union(…, {by[0]}), …)`",
            f"or put what is cut out into a `hole` in `{s.name}`, which cuts all of it",
            "to see them as two pieces, make each a `solid` of its own in an `assembly`",
        ),
    )


def united_notes(
    root: SolvedStructure,
    bodies: Collection[str],
    other: Callable[[SolvedStructure, SolvedStructure], list[str]],
    *,
    hint: str = "write it before `{0}`, or make `{0}` an `assembly` of several bodies",
) -> list[Diagnostic]:
    """Returns a warning for each statement of structures in a body, or cutting it, with attributes that count
    for nothing there: those that `other` gives for a structure and its body. `hint` has a place for the name
    of the body.
    """
    found: dict[object, tuple[SolvedStructure, SolvedStructure, list[str], list[str]]] = {}

    def visit(s: SolvedStructure, body: SolvedStructure | None) -> None:
        if s.path in bodies or s.kind == "drawing":
            body = s
        elif body is not None and body.kind == "solid" and (words := other(s, body)):
            found.setdefault(s.span or s.path, (s, body, words, []))[3].append(s.path)
        for child in s.structures:
            visit(child, body)

    visit(root, None)
    return [_united(*case, hint) for case in found.values()]


def _united(
    s: SolvedStructure, body: SolvedStructure, words: list[str], paths: list[str], hint: str
) -> Diagnostic:
    counts = "counts" if len(words) == 1 else "count"
    are = "it is" if len(paths) == 1 else "they are"
    return Diagnostic(
        "W0727",
        f"{' and '.join(ticked(words, '@'))} of {named(paths, 3)} {counts} for nothing: "
        f"{are} one body with `{body.path}`",
        s.span,
        "cuts it" if s.kind == "hole" else "united with it",
        hints=(hint.format(body.name),),
    )


def stroked_note(structure: SolvedStructure, text: SolvedGeometry) -> Diagnostic:
    """Returns the error on letters of single lines that are to enclose something."""
    return Diagnostic(
        "E0373",
        f"the letters of `{local(structure, text)}` are single lines, and enclose nothing in "
        f"{structure.kind} `{structure.path}`",
        text.span or structure.span,
        "lines without a width",
        hints=(
            "to engrave them, write them in a `drawing`",
            "`thick(text(…), 1mm)` gives them a width, and texts in another font have one",
        ),
    )


def unusable_note(structure: SolvedStructure, leaf: SolvedGeometry, whole: SolvedGeometry) -> Diagnostic:
    """Returns the diagnostic on a curve without extent or place; `whole` is the geometry not drawn."""
    name, curve = local(structure, whole), leaf.curve
    if curve is not None and not curve.is_finite():
        what = "has no place"
        label = "its coordinates divide by zero or leave the range of numbers"
        hint = "look for a division by an unknown that starts at 0, and give it another first guess"
    elif curve is not None and not max(map(abs, curve.box)) <= LARGEST:
        what, label = "is too large", f"this {whole.type} reaches further than {LARGEST:g} mm"
        hint = "look for a size or position that was written in another unit, or multiplied once too often"
    else:
        what, label = "has no extent", f"this {whole.type} is a single point"
        size = next((k for k in _MEASURES if k in whole.values), "length")
        hint = f"constraints may have shrunk it: hold it open with `constrain {name}.{size} >= …`"
    span = whole.span or structure.span
    return Diagnostic(
        "W0706", f"`{name}` in `{structure.path}` {what} and is not drawn", span, label, hints=(hint,)
    )


_MEASURES = ("radius", "rx", "width", "length", "size", "diameter", "module")
"""Measures by which a geometry may be held open."""


# --- Diagnostics on imported outlines that are open, in solids and holes.

_MOST_ENDS = 100
"""Open ends of one outline among which the two nearest are sought."""


def finding_notes(finding: Finding, network: Network) -> Iterator[Diagnostic]:
    """Yields the warnings about a finding: open curves are one only in solids and holes, those imported
    apart.
    """
    match finding:
        case Diagnostic():
            yield finding
        case Covered():
            yield _covered_holes(finding) if finding.holes else _inner_loop(finding)
        case LooseCurves(structure, curves) if structure.kind != "assembly":
            traced = {g.path: g for top in structure.geometry for g in top.walk() if g.type == "traced"}
            own = [curve for curve in curves if curve[0].piece_of in traced]
            if own:
                yield _open(finding, own, traced[own[0][0].piece_of or ""], network)
            if rest := tuple(curve for curve in curves if curve not in own):
                yield _loose_curves(replace(finding, curves=rest), network)


def _open(
    finding: LooseCurves,
    curves: Sequence[tuple[SolvedGeometry, int]],
    drawing: SolvedGeometry,
    network: Network,
) -> Diagnostic:
    s = finding.structure
    meeting = network.meeting(finding.numbers)
    outlines: dict[str, list[Vec]] = defaultdict(list)
    for leaf, number in curves:
        loose = [p for p in network.curves[number].ends if meeting[network.node(p)] <= 1]
        outlines[leaf.path.rpartition(".")[0]] += loose
    name, loose = min(outlines.items(), key=lambda item: _apart(_nearest(item[1])))
    gap = _nearest(loose)
    place = ""
    if gap is not None:
        away = f"{rough(_apart(gap))} mm from there at {at(gap[1])}"
        place = f": `{label(name)}` ends at {at(gap[0])}, and {away}"
    what = counted(len(outlines), "outline")
    called = drawing.path.removeprefix(f"{s.path}.").removesuffix(".art")
    enclose = "encloses" if len(outlines) == 1 else "enclose"
    names = named(label(path) for path in outlines)
    return Diagnostic(
        "W0751",
        f"{what} of `{called}` {enclose} nothing in {s.kind} `{s.path}`{place}",
        drawing.span or s.span,
        f"{names} {'is' if len(outlines) == 1 else 'are'} open",
        hints=(f"{AGAIN}, so that its ends meet", "in a `drawing` open lines are engraved as they are"),
        points=gap or (),
    )


def _nearest(found: Sequence[Vec]) -> tuple[Vec, Vec] | None:
    pairs = combinations(islice(found, _MOST_ENDS), 2)
    return min(pairs, key=_apart, default=None)


def _apart(pair: tuple[Vec, Vec] | None) -> float:
    return math.inf if pair is None else math.dist(*pair)
