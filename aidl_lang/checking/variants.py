"""Subsets of the language, which show what hierarchy and what constraints are worth, and what was added.

`no-hierarchy` has one structure, and all geometry and all constraints are in it. A hole in it is cut by an
operation on outlines (`cut`), which any structure has. `no-constraints` has nothing to solve for: everything
stands as it is written. `paper` has the primitives, constraints and operators of the paper on AIDL, and its
solver. All leave the insides of the library's own shapes alone.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum

from aidl_lang.common.records import record


class Variant(StrEnum):
    FULL = "full"
    NO_HIERARCHY = "no-hierarchy"
    NO_CONSTRAINTS = "no-constraints"
    PAPER = "paper"


class Construct(StrEnum):
    """A construct that a variant may lack."""

    HOLE = "hole in a structure"
    STRUCTURE = "structure in another or beside it"
    LOOSE = "geometry or constraint beside a structure"
    TEMPLATE = "template"
    SHAPE = "shape of one's own"
    CONSTRAINT = "constraint"
    UNKNOWN = "unknown"
    DEFINITION = "constraint of one's own"
    RELATION = "relation that is checked"
    SMOOTH = "smooth step"
    BEYOND = "what came after the paper"


@record()
class Restriction:
    """The diagnostic for a construct; `{name}` is its name."""

    code: str
    message: str
    hint: str


PAPER_NAMES = frozenset(
    (  # noqa: SIM905 (a list of words)
        "point line arc circle rectangle triangle rounded_rectangle polygon "
        "above below left_of right_of inside centered_in centered_horizontally centered_vertically touching "
        "taller shorter wider narrower same_width same_height same_size "
        "horizontal vertical length radius diameter fixed coincident concentric tangent equal equal_length "
        "equal_radius symmetric parallel perpendicular collinear midpoint on_segment distance "
        "horizontal_distance vertical_distance angle "
        "sin cos asin acos sqrt abs norm min max len range enumerate zip reversed sum str vector"
    ).split()
)
"""What programs may call in `paper`: its primitives, its constraints by the names they have here, its
operators, and what Python gave it besides.
"""

_ONE = "`no-hierarchy` has one structure"
_AS_WRITTEN = "`no-constraints` draws everything as it is written"
_CUT = "cut it out: `body = cut(plate, bore)`"

FORBIDDEN: Mapping[Variant, Mapping[Construct, Restriction]] = {
    Variant.FULL: {},
    Variant.NO_HIERARCHY: {
        Construct.HOLE: Restriction(
            "E0403",
            f"{_ONE}, and `{{name}}` is a hole of its own",
            f"draw its outline in the one structure, and {_CUT}",
        ),
        Construct.STRUCTURE: Restriction(
            "E0403",
            f"{_ONE}, and `{{name}}` is another",
            "write its geometry and constraints straight into the first structure, under names of their own",
        ),
        Construct.LOOSE: Restriction(
            "E0403",
            f"{_ONE}, and this stands outside `{{name}}`",
            "write it inside `{name}`",
        ),
        Construct.TEMPLATE: Restriction(
            "E0404",
            f"{_ONE}, and the template `{{name}}` makes more",
            f"repeat geometry in a loop, `for i in 0..3 {{ bore[i] = circle(…) }}`; if it is a hole, {_CUT}",
        ),
        Construct.SHAPE: Restriction(
            "E0405",
            "in `no-hierarchy` all geometry is on one level, and the shape `{name}` has parts of its own",
            "write its parts where it is used, or make it one `path` or `polygon`; `fn` can work out points",
        ),
    },
    Variant.NO_CONSTRAINTS: {
        Construct.CONSTRAINT: Restriction(
            "E0406",
            f"{_AS_WRITTEN} and has no constraints",
            "write where things are and how large: by numbers, `param`s, or parts of geometry above, as in "
            "`center: plate.top_left + (5, -5)`",
        ),
        Construct.UNKNOWN: Restriction(
            "E0407",
            f"{_AS_WRITTEN}, and `{{name}}` is an unknown",
            "name its value by `let`, or make it a `param`",
        ),
        Construct.DEFINITION: Restriction(
            "E0408",
            f"{_AS_WRITTEN}, and `{{name}}` defines a constraint",
            "let a function work out what it ties, as in `fn top_of(a) = a.center + (0, 10)`",
        ),
        Construct.RELATION: Restriction(
            "E0409",
            "`no-constraints` has no relations, and `{name}` is one",
            "compare coordinates or measures, as in `assert lid.bottom >= box.top`",
        ),
        Construct.SMOOTH: Restriction(
            "E0409",
            f"{_AS_WRITTEN}, and `{{name}}` would move a step of the path",
            "give the points of a smooth outline, or use `tangent_arc_to` and `arc_by`, which go on smoothly",
        ),
    },
    Variant.PAPER: {
        Construct.BEYOND: Restriction(
            "E0986",
            "`paper` has what the paper on AIDL describes, and `{name}` came later",
            "draw with `line`, `arc`, `circle`, `rectangle` or `polygon`, cut with `hole`, and constrain",
        ),
    },
}

_ABSENT: Mapping[Variant, str] = {
    Variant.NO_HIERARCHY: r"\bhole\b|\btemplate\b|\b(solid|drawing|assembly) \S+ \{|`drawing`",
    Variant.NO_CONSTRAINTS: r"\b(constrain|prefer|var|guess|fixed)\b|\bas a constraint\b|\bfirst guess\b",
}

_INSTEAD: Mapping[tuple[Variant, str], str] = {
    (Variant.NO_HIERARCHY, "W0701"): f"to make it a hole, {_CUT}",
    (Variant.NO_CONSTRAINTS, "E0401"): "name the value in the structure around both, as in "
    "`let middle = (10, 0)`, and use the name in both",
}


def speaks_of_absent(variant: Variant, text: str) -> bool:
    """Tells whether a hint or an edit advises a construct that the variant lacks."""
    pattern = _ABSENT.get(variant)
    return pattern is not None and re.search(pattern, text) is not None


def instead(variant: Variant, code: str) -> tuple[str, ...]:
    """Returns the hint of a diagnostic whose own hints advise a construct that the variant lacks."""
    hint = _INSTEAD.get((variant, code))
    return (hint,) if hint else ()
