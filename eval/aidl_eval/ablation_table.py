"""Ways of solving compared, as Markdown and CSV: programs, means with intervals, differences to `full`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_eval import table
from aidl_eval.ablation import FULL, WAYS, WRONG, Solved
from aidl_eval.statistics import RESAMPLES
from aidl_eval.summary import Figure, Mean, Pair, Row, Share, pairs

_ALL = "solved"
"""The one figure that is over all programs."""
_MEANINGS = {
    _ALL: "programs all of whose constraints hold, of those that are no error",
    "milliseconds": "of the processor, for a program; the quickest of three solves if the first was quick",
    "disturbed": "structures whose own geometry is not where it was in their frame, of those that draw",
    "bent": "structures whose own geometry is another, however it is moved and turned as a whole",
    "drift": "root mean square of all changes from the first guesses, in mm; a turn counts as what it "
    "moves at the size of the drawing",
    "sizes": "written sizes that had to change, of a program",
    "missed": "constraints of a program that do not hold as it means them",
}


def markdown(solves: Sequence[Solved]) -> str:
    """Returns a table of all solves, one of the ways over the programs that all of them solve, and one of
    their differences to the full solver.
    """
    fair, tried = _fair(solves), [s for s in solves if s.way == FULL and s.status != WRONG]
    things = len(dict.fromkeys(s.thing for s in fair if s.way == FULL))
    means = [[row.variant, *(table.shown(row.figures[name]) for name in _MEANINGS)] for row in _rows(solves)]
    parts = [
        "# Ways to solve",
        table.tabulated([["program", "way", "status", *list(_MEANINGS)[1:]], *map(_line, solves)]),
        "## Means",
        f"All but `{_ALL}` are over the {len(fair) // len(WAYS)} programs of {len(tried)} that every way "
        f"solves; they draw {things} things. In square brackets 95 % intervals by drawing things with "
        f"replacement, with all programs of each ({RESAMPLES:,} resamples); after ± the standard deviation; "
        "in round brackets what figures are taken over.",
        table.tabulated([["way", *_MEANINGS], *means]),
        f"## Less `{FULL}`",
        "By thing: each counts once (1.00 is 100 %). Two-sided p of the paired permutation test; Holm's "
        "correction is for the ways compared in one figure. Where no line is, there is no difference in any "
        "thing.",
        table.compared([p for p in _pairs(solves) if _differs(p)], "ways", "things"),
        "## What the words mean",
        "\n".join(_meanings(solves)),
    ]
    return "\n\n".join(parts) + "\n"


def to_csv(solves: Sequence[Solved]) -> str:
    """Returns one line for each figure of each way, over all programs and for each, then the differences."""
    each = [_row(s.way, [s], [s], s.program) for s in solves if s.status != WRONG]
    return table.to_csv([*_rows(solves), *each], _pairs(solves))


def _fair(solves: Sequence[Solved]) -> list[Solved]:
    """Returns the solves of the programs that every way solves."""
    failing = {s.program for s in solves if s.status != "solved"}
    return [s for s in solves if s.program not in failing]


def _rows(solves: Sequence[Solved]) -> list[Row]:
    fair, of_error = _fair(solves), {s.program for s in solves if s.way == FULL and s.status == WRONG}
    tried = [s for s in solves if s.program not in of_error]
    return [_row(way, [s for s in tried if s.way == way], [s for s in fair if s.way == way]) for way in WAYS]


def _row(way: str, tried: Sequence[Solved], fair: Sequence[Solved], program: str | None = None) -> Row:
    figures: Mapping[str, Figure] = {
        _ALL: Share.of(((s.thing, int(s.status == "solved"), 1) for s in tried), several=True),
        "milliseconds": Mean.of((s.thing, 1000.0 * s.seconds) for s in fair),
        "disturbed": Share.of(((s.thing, s.disturbed, s.parts) for s in fair), several=True),
        "bent": Share.of(((s.thing, s.bent, s.parts) for s in fair), several=True),
        "drift": Mean.of((s.thing, s.drift) for s in fair),
        "sizes": Mean.of((s.thing, s.sizes) for s in fair),
        "missed": Mean.of((s.thing, s.missed) for s in fair),
    }
    return Row(way, program, len(tried), 0, figures)


def _pairs(solves: Sequence[Solved]) -> list[Pair]:
    return pairs(_rows(solves), _MEANINGS, FULL)


def _differs(pair: Pair) -> bool:
    found = pair.comparison
    return found.difference != 0.0 or found.interval not in (None, (0.0, 0.0))


def _line(s: Solved) -> list[str]:
    if s.status == WRONG:
        return [s.program, s.way, s.status, *[""] * (len(_MEANINGS) - 1)]
    of = (f"{count} of {s.parts}" for count in (s.disturbed, s.bent))
    numbers = (f"{1000.0 * s.seconds:.1f}", *of, f"{s.drift:.3g}", str(s.sizes), str(s.missed))
    return [s.program, s.way, s.status, *numbers]


def _meanings(solves: Sequence[Solved]) -> Iterator[str]:
    yield from (f"- {name}: {meaning}" for name, meaning in _MEANINGS.items())
    yield from (f"- `{name}`: {way.meaning}" for name, way in WAYS.items())
    for name, way in WAYS.items():
        own = [s for s in solves if s.way == name and s.status != WRONG]
        if way.whole_boxes:
            others = sum(s.is_other for s in own)
            yield f"- The problem of `{name}` is another one in {others} of {len(own)} programs."
