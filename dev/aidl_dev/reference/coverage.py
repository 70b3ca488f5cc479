"""The table of each constraint with each pair of things, made by compiling a program for every cell.

A cell works if the program solves and the constraint holds and relates both things; it is refused if the
compiler says so; anything else is a fault, and the tests allow none.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from aidl_lang import pipeline
from aidl_lang.checking.types import PRIMITIVES
from aidl_lang.common.diagnostics import MOST_ERRORS
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.solved import ConstraintReport
from aidl_lang.tools.reference import collect

KINDS: Mapping[str, str] = {
    **{kind: f"{{n}} = {each.sample}" for kind, each in PRIMITIVES.items() if each.sample},
    "rectangle": "{n} = rectangle(center: ({x}, {y}), width: 14, height: 8)",
    "shape": "{n} = star(center: ({x}, {y}), outer_radius: 8, inner_radius: 4)",
    "structure": "drawing {n} {{ body = ellipse(center: ({x}, {y}), rx: 7, ry: 5) }}",
    "list": "for i in 0..1 {{ {n}[i] = circle(center: ({x} + 14 * i, {y} + i), radius: 4 + i) }}",
    "number": "var {n} = {x} + 5",
}
"""Kinds of things, with the text of one at a place. Editors know them by the heads of the tables."""

_PAIR = "{name}(a, b)"
_ONE = "{name}(a)"

FORMS: dict[str, tuple[str, ...]] = {
    "horizontal": (_ONE, _PAIR),
    "vertical": (_ONE, _PAIR),
    "midpoint": (_PAIR, "{name}(a, b, origin)"),
    "symmetric": ("{name}(a, about: y_axis)", "{name}(a, b, about: y_axis)", "{name}(a, b, about: origin)"),
    "mirror_of": ("{name}(a, b, about: y_axis)",),
    "distance": ("{name}(a, b) == 40",),
    "horizontal_distance": ("{name}(a, b) == 40",),
    "vertical_distance": ("{name}(a, b) == 40",),
    "gap": ("{name}(a, b) == 40",),
    "clearance": ("{name}(a, b) >= 40",),
    "angle": ("{name}(a, 25deg)", "{name}(a, b) == 25deg"),
    "length": ("{name}(a) == 15",),
    "radius": ("{name}(a) == 9",),
    "diameter": ("{name}(a) == 18",),
    "centered_between": ("{name}(a, b, origin)",),
    "flush": ("{name}(a, b, side: left)",),
    "row": ("{name}(a, b, gap: 3)",),
    "column": ("{name}(a, b, gap: 3)",),
    "evenly_spaced": ("{name}(a, b, gap: 3, axis: x)",),
    "on_circle": ("{name}([a, b], center: origin, radius: 30)",),
    "spread": ("{name}([a, b], inside: box, axis: x)",),
    "at_corners": ("{name}([a, b, p, q], box)",),
}
"""The calls of constraints that differ from `name(a, b)`."""

_BESIDE = {
    "box": "box = rectangle(center: fixed((0, 0)), width: 90, height: 60)",
    "p": "p = (-20, -10)",
    "q": "q = (20, -12)",
}
"""Other things that a call mentions."""

_ALSO = tuple("distance horizontal_distance vertical_distance gap clearance angle length radius".split())
"""Measures, which constrain when compared."""

_WITHOUT_TABLE = ("meshes", "dimension")
"""Constraints without a table: between things of one shape only (gears), and one that constrains nothing."""


@record()
class Cell:
    """The result of a constraint on things of two kinds; `second` is "" for a single thing.

    outcome  `works`, `refused`, or the fault
    """

    name: str
    form: str
    first: str
    second: str
    outcome: str
    message: str = ""

    @property
    def is_fault(self) -> bool:
        return self.outcome not in ("works", "refused")


_AT_ONCE = MOST_ERRORS // 2
"""Cells in a program: few enough that all errors are reported if each of them is refused."""


def constraints() -> list[str]:
    """Returns all constraints, in the order of the reference."""
    entries = collect.reference().entries.values()
    found = [e.name for e in entries if e.sort in ("constraint", "relation") or e.name in _ALSO]
    return [name for name in found if name not in _WITHOUT_TABLE]


def cells(name: str) -> Iterator[Cell]:
    """Yields all cells of a constraint: compiled many at once, and those not refused again alone."""
    for form in FORMS.get(name, (_PAIR,)):
        yield from _cells(name, form)


def _cells(name: str, form: str) -> Iterator[Cell]:
    seconds = KINDS if re.search(r"\bb\b", form) else ("",)
    pairs = list(product(KINDS, seconds))
    lines = [_program(name, form, *pair, i) for i, pair in enumerate(pairs)]
    refused: dict[int, str] = {}
    for begin in range(0, len(pairs), _AT_ONCE):
        for d in _compiled(lines, range(begin, min(begin + _AT_ONCE, len(pairs)))).diagnostics:
            if d.is_error and d.span is not None and d.span.line > 1:
                refused.setdefault(d.span.line - 2, f"{d.code}: {d.message}")
    kept = [i for i in range(len(pairs)) if i not in refused]
    solved = _compiled(lines, kept)
    reports = {c.path: c for c in solved.model.constraints} if solved.model else {}
    for i, (first, second) in enumerate(pairs):
        if i in refused:
            yield Cell(name, form, first, second, "refused", refused[i])
        else:
            yield Cell(name, form, first, second, _judged(reports.get(f"all.cell{i}"), i, first, second))


def _program(name: str, form: str, first: str, second: str, number: int) -> str:
    things = [KINDS[first].format(n="a", x=3, y=7)]
    if second:
        things.append(KINDS[second].format(n="b", x=31, y=18))
    stated = form.format(name=name)
    things += [written for word, written in _BESIDE.items() if re.search(rf"\b{word}\b", stated)]
    return f"drawing cell{number} at ({200 * number}, 0) {{ {'; '.join(things)}; constrain {stated} }}"


def _whole(lines: Sequence[str], kept: Sequence[int]) -> str:
    return "\n".join(["drawing all {", *(line if i in kept else "" for i, line in enumerate(lines)), "}"])


def _compiled(lines: Sequence[str], kept: Sequence[int]) -> pipeline.Compiled:
    return pipeline.compile(SourceFile("cells", _whole(lines, kept)))


def _judged(report: ConstraintReport | None, number: int, first: str, second: str) -> str:
    if report is None:
        return "without effect"
    # A `var` belongs to the drawing; everything else is mentioned under its own name.
    wanted = {n for n, kind in (("a", first), ("b", second)) if kind not in ("", "number")}
    names = {p.removeprefix(f"all.cell{number}.").split(".")[0].split("[")[0] for p in report.mentions()}
    if not names or not wanted <= names:
        return "without effect on " + " and ".join(sorted(wanted - names))
    return "works" if report.satisfied else f"not satisfied: {report.residual:g}"


# --- Writing -------------------------------------------------------------------------------------


def table(name: str, of: Iterable[Cell]) -> str:
    """Returns the cells of a constraint as Markdown: rows are the first thing, columns the second."""
    found: dict[str, list[Cell]] = {}
    for cell in of:
        found.setdefault(cell.form, []).append(cell)
    return "\n\n".join([f"## {name}", *(_matrix(name, form, group) for form, group in found.items())])


def _matrix(name: str, form: str, found: Sequence[Cell]) -> str:
    stated = f"`{form.format(name=name)}`"
    works = {(c.first, c.second) for c in found if c.outcome == "works"}
    if all(not c.second for c in found):
        return f"{stated}: {', '.join(k for k in KINDS if (k, '') in works) or 'nothing'}"
    firsts = [k for k in KINDS if any((k, b) in works for b in KINDS)]
    others = [k for k in KINDS if k not in firsts]
    if firsts and len(others) < 4 and works == set(product(firsts, firsts)):
        return f"{stated}: any two" + (f", but no {' and no '.join(others)}" if others else "")
    rows = [header(), "|---" * (len(KINDS) + 1) + "|"]
    rows += [f"| **{a}** | {' | '.join('●' if (a, b) in works else '·' for b in KINDS)} |" for a in firsts]
    return stated + "\n\n" + "\n".join(rows)


def header() -> str:
    """The first row of each table."""
    return f"| a ╲ b | {' | '.join(KINDS)} |"


HEAD = """# What goes with what

Made by compiling a program for each constraint and each pair of things. ● works: it is accepted, solves, and
relates both things. What is not marked is refused with a message that says why. *shape* is a star and stands
for all compound shapes, *structure* is a drawing with a curve in it, *list* two circles.
"""


def page() -> str:
    """Returns all tables, made by as many processes as there are cores: they take minutes of a processor."""
    from concurrent.futures import ProcessPoolExecutor

    with ProcessPoolExecutor() as pool:
        return "\n".join([HEAD, *pool.map(_section, constraints())])


def _section(name: str) -> str:
    return table(name, cells(name)) + "\n"


def headings(text: str) -> list[str]:
    """Returns the constraints that have tables in a page."""
    return [name for name, _ in _sections(text)]


def unshown(text: str) -> list[str]:
    """Returns the constraints that take nothing, by their tables in a page or, without one, as tried now."""
    shows = re.compile(r"●|^`[^`]+`: (?!nothing)", re.MULTILINE)
    shown = {name: shows.search(section) is not None for name, section in _sections(text)}
    new = (name for name in constraints() if name not in shown)
    shown |= {name: any(cell.outcome == "works" for cell in cells(name)) for name in new}
    return [name for name, takes_something in shown.items() if not takes_something]


def _sections(text: str) -> list[tuple[str, str]]:
    parts = (part.partition("\n") for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:])
    return [(name, section) for name, _, section in parts]
