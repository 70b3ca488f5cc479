"""Diagnostics on derived outlines and finished corners."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.prose import named, rough
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry import finishing
from aidl_lang.geometry.finishing import Corner, Result, TooLarge, Work
from aidl_lang.geometry.notes import local
from aidl_lang.geometry.solved import Finish, Leaves, Recipe, SolvedGeometry, SolvedStructure, at
from aidl_lang.geometry.tiling import MOST

_ONE_WAY = 5
"""Points of a lattice that has no second step."""
_OPERATION = {"difference": "cut"}


def _sources(recipe: Recipe) -> list[str]:
    names = ((g.name, g.type) for group in recipe.operands for g in group)
    return [kind if name.startswith("source[") else name for name, kind in names]


# --- Outlines ------------------------------------------------------------------------------------


def nothing_left(g: SolvedGeometry, recipe: Recipe, depth: float | None = None) -> Diagnostic:
    """Returns an outline of which nothing remains."""
    sources, hint = _sources(recipe), ""
    match recipe.kind:
        case "offset":
            amount = rough(abs(recipe.numbers["distance"]))
            message = f"nothing is left of `{sources[0]}` when it is moved inwards by {amount}"
            gone = rough(depth or 0)
            hint = f"less than {gone} fits: choose a smaller distance, or make the outline larger"
        case "hull":
            lie = "lie" if len(set(sources)) > 1 else "lies"
            message = f"`{g.path}` has no area: {named(sources)} {lie} on one line"
            hint = "a hull goes around circles, outlines, or three points and more"
        case "thick":
            message = f"`{g.path}` has no width: it is {rough(recipe.numbers['width'])}"
            hint = "hold it open with a constraint, or write a width above 0"
        case "difference":
            message = f"nothing is left of `{sources[0]}` in `{g.path}`: it is cut away whole"
            hint = "look at the order: `cut(a, b)` is a without b"
        case "tiled":
            region, whole = recipe.operands[1][0].name, " whole" if "whole" in recipe.words else ""
            message = f"no{whole} copy of the cell of `{g.path}` lies in `{region}`"
            hint = "make the cell smaller or the steps shorter, or the region larger"
        case _:
            message = f"{named(sources)} have nothing in common, so `{g.path}` is empty"
            hint = "place them so that they overlap, as they shall in the drawing"
    return Diagnostic("E0339", message, g.span, "no outline comes of this", hints=(hint,))


def not_closed(g: SolvedGeometry, recipe: Recipe, operand: Iterable[SolvedGeometry]) -> Diagnostic:
    names = [one.name for one in operand]
    need = f"`{_OPERATION.get(recipe.kind, recipe.kind)}` needs an outline"
    return _open(names, need, g.span, f"for a stroke along open curves: `thick({names[0]}, 4)`")


def open_clip(s: SolvedStructure) -> Diagnostic:
    """Returns the diagnostic on a structure clipped to curves that enclose nothing."""
    need = f"`{s.path}` is clipped to {'them' if len(s.clip) > 1 else 'it'}"
    return _open([g.name for g in s.clip], need, s.span, "curves that close together are given as a list")


def _open(names: Sequence[str], need: str, span: Span | None, hint: str) -> Diagnostic:
    enclose = "enclose" if len(names) > 1 else "encloses"
    message = f"{named(names)} {enclose} nothing, and {need}"
    hints = ("close the outline, sharing the end points", hint)
    return Diagnostic("E0338", message, span, "the curves are not closed", hints=hints)


def no_lattice(g: SolvedGeometry, recipe: Recipe) -> Diagnostic:
    """Returns the diagnostic on steps that lead to no second copy, or along one line."""
    one = len(recipe.operands[2]) == _ONE_WAY
    return Diagnostic(
        "E0356",
        f"the steps of `{g.path}` {'have no length' if one else 'lead along one line'}",
        g.span,
        "the copies would lie on each other" if one else "copies in rows need two ways",
        hints=("a pitch, a width and a height are above 0; `by: (10, 0), row: (0, 8)` leads two ways",),
    )


def too_many(g: SolvedGeometry, recipe: Recipe, count: int) -> Diagnostic:
    region = recipe.operands[1][0].name
    return Diagnostic(
        "E0357",
        f"`{g.path}` takes {count:,} copies to fill `{region}`, and {MOST:,} is the most",
        g.span,
        "too fine for this region",
        hints=("choose longer steps (a larger pitch), or fill a smaller region",),
    )


def splits(g: SolvedGeometry, recipe: Recipe, count: int) -> Diagnostic:
    amount, source = rough(abs(recipe.numbers["distance"])), _sources(recipe)[0]
    return Diagnostic(
        "W0710",
        f"`{g.path}` falls into {count} pieces: `{source}` is narrower than twice {amount} in places",
        g.span,
        "the offset closes the narrow parts",
        hints=("choose a smaller distance, or widen the narrow parts, if it should be one piece",),
    )


def all_wall(g: SolvedGeometry, recipe: Recipe, depth: float) -> Diagnostic:
    source, wall = _sources(recipe)[0], rough(recipe.numbers["thickness"])
    return Diagnostic(
        "W0711",
        f"the wall of `{g.path}` fills all of `{source}`: it is {wall} thick",
        g.span,
        "no room is left inside",
        hints=(f"a wall below {rough(depth)} leaves room",),
    )


# --- Corners -------------------------------------------------------------------------------------


def no_room(f: Finish, corner: Corner, told: SolvedStructure) -> Diagnostic:
    """Returns the diagnostic on a finish that is to be as large as fits where nothing does."""
    why = "its curves meet there without an angle" if corner.is_cusp else "other corners take its edges up"
    return Diagnostic(
        "E0527",
        f"there is no room for the {f.kind} of `{f.text}` at {at(corner.at)} in `{told.path}`: {why}",
        f.span,
        "nothing fits",
        hints=("leave it out, or make the other ones smaller",),
        points=(corner.at,),
    )


def no_corner(f: Finish, leaves: Leaves, near: float) -> Diagnostic:
    """Returns the diagnostic on a place where no two curves end, or where they run on smoothly."""
    if f.at is None:
        return Diagnostic(
            "E0335",
            f"`{f.text}` has no corners",
            f.span,
            "nothing to finish",
            hints=(
                "a corner is where two of its curves meet at an angle; name an end of an edge as a point",
            ),
        )
    curves = [c for _, c in leaves]
    arms = finishing.arms_at(curves, f.at, near)
    place = f.at
    corners = sorted(finishing.corners_of(curves, near), key=lambda c: math.dist(c.at, place))
    if len(arms) == 2:
        message = f"`{f.text}` at {at(f.at)} is no corner: the curves run on smoothly"
        label = "nothing to finish"
    elif len(arms) > 2:
        message, label = f"more than two curves end in `{f.text}` at {at(f.at)}", "which two is not clear"
    else:
        message, label = f"no two curves end in `{f.text}` at {at(f.at)}", "not a corner"
    hints = []
    if corners:
        hints.append(f"the nearest corners are at {', '.join(at(c.at) for c in corners[:3])}")
    hints.append("a corner is a point that is the end of two curves: `plate.top_left`, `profile.corner[2]`")
    return Diagnostic("E0335", message, f.span, label, hints=tuple(hints), points=(f.at,))


def twice(f: Finish, earlier: Finish, corner: Corner, told: SolvedStructure) -> Diagnostic:
    return Diagnostic(
        "E0336",
        f"the corner at {at(corner.at)} of `{told.path}` is finished twice",
        f.span,
        f"a second {f.kind}",
        (Label(earlier.span, f"finished here already, by `{earlier.text}`"),),
        ("keep one of them; to treat corners differently, name them one by one",),
        points=(corner.at,),
    )


# --- Fillets and chamfers that do not fit: one finding for each fault, with the largest size that does.
#
# A size is only named after the corners were worked out with it, as it is printed.


@record()
class Misfit:
    """A fault of one or several statements, and the largest size that fits in all of them."""

    statements: frozenset[Span]
    most: float
    note: Diagnostic


def misfits(
    result: Result, works: Sequence[Work], reasons: Sequence[Finish], leaves: Leaves, told: SolvedStructure
) -> Iterator[Misfit]:
    """Yields the finishes that do not fit, each fault once, by statements that meet."""
    reason_of = {id(work): reason for work, reason in zip(works, reasons, strict=True)}
    for group in _groups(result.failures, reason_of):
        fault = _Fault(group, works, reason_of, leaves, told)
        yield Misfit(fault.spans, fault.most, fault.note())


def _groups(failures: Sequence[TooLarge], reason_of: dict[int, Finish]) -> list[list[TooLarge]]:
    """Failures that have a statement in common, directly or by others."""
    groups: list[tuple[set[Span], list[TooLarge]]] = []
    for failure in failures:
        spans, found = {reason_of[id(w)].span for w in _works(failure)}, [failure]
        for known in [known for known in groups if known[0] & spans]:
            groups.remove(known)
            spans, found = spans | known[0], known[1] + found
        groups.append((spans, found))
    return [found for _, found in groups]


def _works(failure: TooLarge) -> list[Work]:
    return [failure.work] if failure.other is None else [failure.work, failure.other]


@record(frozen=False)
class _Fault:
    """Failures that are one fault. `own` are the works whose size is changed to find one that fits: all that
    take part if they have one size, else those of the last statement.
    """

    failures: Sequence[TooLarge]
    works: Sequence[Work]
    reason_of: dict[int, Finish]
    leaves: Leaves
    told: SolvedStructure

    def __post_init__(self) -> None:
        self.first = self.failures[0]
        self.reason = self.reason_of[id(self.first.work)]
        self.spans = frozenset(self.reason_of[id(w)].span for f in self.failures for w in _works(f))
        self.own = self._of(self.spans)
        self.is_equal = len({max(w.sizes) for w in self.own}) == 1
        if not self.is_equal:
            self.own = self._of({self.reason.span})
        self.is_cusp = any(f.work.corner.is_cusp for f in self.failures)
        self.most = 0.0 if self.is_cusp else self._most()

    def _of(self, spans: frozenset[Span] | set[Span]) -> list[Work]:
        return [w for w in self.works if self.reason_of[id(w)].span in spans]

    @property
    def what(self) -> str:
        return "radius" if self.reason.kind == "fillet" else "size"

    def _most(self) -> float:
        """Returns the largest size, as it is printed, with which all corners of these statements work out."""
        now = max(max(w.sizes) for w in self.own)
        found = finishing.largest(self._fits, now)
        for most in (_floor(found * (1 + 1e-9)), _floor(found)):
            if most > 0 and self._fits(most):
                return most
        return 0.0

    def _fits(self, size: float) -> bool:
        own = {id(w) for w in self.own}
        turned = [finishing.sized(w, size) if id(w) in own else w for w in self.works]
        mine = {id(t) for t, w in zip(turned, self.works, strict=True) if id(w) in own}
        result = finishing.finish([curve for _, curve in self.leaves], turned)
        return not any(id(w) in mine for failure in result.failures for w in _works(failure))

    def note(self) -> Diagnostic:
        failure, f = self.first, self.reason
        message, points = self._message()
        other = self.reason_of[id(failure.other)] if failure.other is not None else f
        labels = (Label(other.span, "the other one"),) if other.span != f.span else ()
        fix = self._fix() if self.most > 0 else None
        return Diagnostic("E0518", message, f.span, "too large", labels, (self._hint(),), fix, points)

    def _message(self) -> tuple[str, tuple[tuple[float, float], ...]]:
        failure, f = self.first, self.reason
        corner = (
            f"`{f.text}`" if f.at is not None else f"the corner at {at(failure.work.corner.at)} of `{f.text}`"
        )
        size = rough(max(failure.work.sizes))
        if failure.other is not None:
            other = self.reason_of[id(failure.other)]
            edge = local(self.told, self.leaves[failure.number][0])
            a, b = failure.other.corner.at, failure.work.corner.at
            return (
                f"the {f.kind} at {at(b)} runs into the {other.kind} at {at(a)} on `{edge}`: "
                f"{self.what} {size} is too large"
            ), (a, b)
        arms = failure.work.corner.arms
        edges = named([local(self.told, self.leaves[arm.number][0]) for arm in arms])
        if self.is_cusp:
            message = f"{corner} has no {f.kind}: {edges} meet there without an angle"
        else:
            room = rough(_floor(failure.largest * (1 + 1e-9)))
            message = (
                f"the {f.kind} of {corner} does not fit: {self.what} {size}, and {edges} have room for {room}"
            )
        return message, (failure.work.corner.at,)

    def _hint(self) -> str:
        if self.is_cusp:
            return "let them meet at an angle"
        beside = len(self.spans) > 1
        if not self.most > 0:
            other = "the other one" if beside else "this shape"
            return f"no {self.what} fits here beside {other}: that has to change"
        if beside and self.is_equal:
            return f"with the same {self.what} in all of them at most {rough(self.most)} fits"
        where = " beside the other" if beside else " at all its corners" if len(self.own) > 1 else ""
        return f"at most {rough(self.most)} fits{where}"

    def _fix(self) -> Fix | None:
        """Returns the size in the statements, where each has it as a number that nothing else decides."""
        edits: dict[Span, Edit] = {}
        for work in self.own:
            reason = self.reason_of[id(work)]
            literal = reason.literal()
            if literal is None or len(set(reason.sizes)) > 1:
                return None
            factor = UNITS[literal.unit][0] if literal.unit else 1.0
            if abs(literal.value * factor - max(work.sizes)) > 1e-9 * max(work.sizes):
                return None  # a copy in another size, or a size that gave way
            text = f"{self.most / factor:.12g}{literal.unit or ''}"
            edits[literal.span] = Edit(literal.span, text)
        texts = list(dict.fromkeys(f"`{edit.replacement}`" for edit in edits.values()))
        where = f" in all {len(edits)}" if len(edits) > 2 else " in both"
        title = f"write {' and '.join(texts)}{where if len(edits) > len(texts) else ''}"
        return Fix(title, tuple(edits.values()))


def merged_notes(found: Sequence[Misfit]) -> list[Diagnostic]:
    """Returns one note for each set of statements: that of the smallest size, which fits everywhere."""
    least: dict[frozenset[Span], Misfit] = {}
    for misfit in found:
        known = least.setdefault(misfit.statements, misfit)
        if misfit.most < known.most:
            least[misfit.statements] = misfit
    return [misfit.note for misfit in least.values()]


def _floor(value: float) -> float:
    """Returns a size rounded down to four digits, so that the printed size fits."""
    if value <= 0:
        return 0.0
    step = 10.0 ** (math.floor(math.log10(value)) - 3)
    return float(rough(math.floor(value / step) * step))
