"""Diagnostics on imported outlines: open ones in solids and holes, and such as cross themselves."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, islice

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import counted, named, rough
from aidl_lang.geometry.bodies import CrossedOutline, Finding, LooseCurves
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import ends
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.notes import at, finding_note
from aidl_lang.geometry.solved import SolvedGeometry
from aidl_lang.geometry.tracing import is_winding

_AGAIN = "mend it in the program that drew it"
_MOST_ENDS = 100
"""Open ends of one outline among which the two nearest are sought."""


def finding_notes(finding: Finding, network: Network) -> Iterator[Diagnostic]:
    """Yields the warnings about a finding, what is imported apart."""
    if isinstance(finding, CrossedOutline):
        yield _crossed(finding)
        return
    if isinstance(finding, LooseCurves) and finding.structure.kind != "assembly":
        imported = {g.path: g for top in finding.structure.geometry for g in top.walk() if g.type == "traced"}
        own = [curve for curve in finding.curves if curve[0].piece_of in imported]
        if own:
            yield _open(finding, own, imported[own[0][0].piece_of or ""], network)
            finding = replace(finding, curves=tuple(c for c in finding.curves if c not in own))
            if not finding.curves:
                return
    if (note := finding_note(finding, network)) is not None:
        yield note


def _label(path: str) -> str:
    """Returns what a shape of a file is called there, by its path."""
    return path.rpartition(".")[2].rpartition("[")[0]


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
        loose = [p for p in ends(network.curves[number]) if meeting[network.node(p)] <= 1]
        outlines[leaf.path.rpartition(".")[0]] += loose
    name, loose = min(outlines.items(), key=lambda item: _apart(_nearest(item[1])))
    gap = _nearest(loose)
    place = ""
    if gap is not None:
        away = f"{rough(_apart(gap))} mm from there at {at(gap[1])}"
        place = f": `{_label(name)}` ends at {at(gap[0])}, and {away}"
    what = counted(len(outlines), "outline")
    called = drawing.path.removeprefix(f"{s.path}.").removesuffix(".art")
    enclose = "encloses" if len(outlines) == 1 else "enclose"
    names = named(_label(path) for path in outlines)
    return Diagnostic(
        "W0751",
        f"{what} of `{called}` {enclose} nothing in {s.kind} `{s.path}`{place}",
        drawing.span or s.span,
        f"{names} {'is' if len(outlines) == 1 else 'are'} open",
        hints=(f"{_AGAIN}, so that its ends meet", "in a `drawing` open lines are engraved as they are"),
        points=gap or (),
    )


def _nearest(found: Sequence[Vec]) -> tuple[Vec, Vec] | None:
    pairs = combinations(islice(found, _MOST_ENDS), 2)
    return min(pairs, key=_apart, default=None)


def _apart(pair: tuple[Vec, Vec] | None) -> float:
    return math.inf if pair is None else math.dist(*pair)


def _crossed(finding: CrossedOutline) -> Diagnostic:
    s, outline = finding.structure, finding.outline
    first, *more = sorted(finding.places)
    further = f" and in {counted(len(more), 'more place')}" if more else ""
    rule = "a winding that is not 0" if is_winding(outline) else "every second area"
    return Diagnostic(
        "W0753",
        f"`{_label(outline.path)}`, imported into {s.kind} `{s.path}`, crosses itself at "
        f"{at(first)}{further}",
        outline.span or s.span,
        f"filled is {rule}",
        hints=(_AGAIN, "crossing lines come out of a cutter as separate pieces"),
        points=(first, *more[:9]),
    )
