"""Diagnostics on derived outlines and finished corners."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.prose import named, rough
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.finishing import Corner, arms_at, corners_of
from aidl_lang.geometry.notes import at
from aidl_lang.geometry.solved import Finish, Recipe, SolvedGeometry, SolvedStructure

Leaves = Sequence[tuple[SolvedGeometry, Piece]]
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
    word = _OPERATION.get(recipe.kind, recipe.kind)
    plural = len(names) > 1
    return Diagnostic(
        "E0338",
        f"{named(names)} {'enclose' if plural else 'encloses'} nothing, and `{word}` needs an outline",
        g.span,
        "the curves are not closed",
        hints=(
            "close the outline, sharing the end points",
            f"for a stroke along open curves: `thick({names[0]}, 4)`",
        ),
    )


def open_clip(s: SolvedStructure) -> Diagnostic:
    """Returns the diagnostic on a structure clipped to curves that enclose nothing."""
    names = [g.name for g in s.clip]
    enclose, it = ("enclose", "them") if len(names) > 1 else ("encloses", "it")
    return Diagnostic(
        "E0338",
        f"{named(names)} {enclose} nothing, and `{s.path}` is clipped to {it}",
        s.span,
        "the curves are not closed",
        hints=("close the outline, sharing the end points", "curves that close together are given as a list"),
    )


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


def too_many(g: SolvedGeometry, recipe: Recipe, count: int, most: int) -> Diagnostic:
    region = recipe.operands[1][0].name
    return Diagnostic(
        "E0357",
        f"`{g.path}` takes {count:,} copies to fill `{region}`, and {most:,} is the most",
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
    arms = arms_at(curves, f.at, near)
    place = f.at
    corners = sorted(corners_of(curves, near), key=lambda c: math.dist(c.at, place))
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
