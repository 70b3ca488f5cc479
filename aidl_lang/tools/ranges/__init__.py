"""Walks each param of a program over its whole range, and tells where something changes kind: what the walks
find, as sentences and as data, and edits that keep it from happening.

`looks` says what a kind is, `walking` how the way is made, and what two params do together.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, replace
from typing import Any

from aidl_lang import parser
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.prose import counted, first_few
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.compiled import Compiled
from aidl_lang.syntax import ast
from aidl_lang.tools.ends import SweepJob, valued
from aidl_lang.tools.ranges.looks import Look, differences, look
from aidl_lang.tools.ranges.walking import LONGEST, Pair, Ranges, Remedy, Turn, Walk, has_way, ranges

__all__ = ["Ranges", "Turn", "Walk", "described", "findings", "has_way", "ranges", "sentence", "sentences"]
__all__ += ["summary", "together", "turned"]

_TOLD = 3
"""Changes of one place that a sentence names."""
_PLACES = 6
"""Places of one param that are told one by one."""
_CALLS = 6
"""Ambiguous calls that are tried to be stated."""
_STILL = 1e-6
_CODE = "W0607"
_AMBIGUOUS = re.compile(
    r"(angle|tangent)\((?P<things>[^()]*(?:\([^()]*\)[^()]*)*)\)(?:\s*==\s*(?P<value>[^,;{}]+))?"
)


def sentence(walk: Walk, turn: Turn) -> str:
    """Describes what is of another kind beyond a place."""
    told = [change.text for change in turn.changes]
    where = f"at `{walk.knob.path} = {valued(walk.knob, turn.after)}` "
    return where + first_few(told, _TOLD, "; and {} more", "; ")


def sentences(walk: Walk) -> Iterator[str]:
    """Yields what is told of a param, each place where the same happens once."""
    seen: dict[object, int] = {}
    told = []
    for turn in sorted(walk.turns, key=lambda t: abs(t.after - float(walk.knob.value))):
        key = tuple(change.key for change in turn.changes)
        seen[key] = seen.get(key, 0) + 1
        if seen[key] == 1:
            told.append((key, turn))
    for key, turn in told[:_PLACES]:
        often = f" (there and at {counted(seen[key] - 1, 'other value')})" if seen[key] > 1 else ""
        yield sentence(walk, turn) + often
        yield from (f"  {remedy.title}" for remedy in turn.remedies)
    if len(told) > _PLACES:
        yield f"`{walk.knob.path}`: {counted(len(told) - _PLACES, 'other place')} where the kind changes"
    if walk.stopped:
        yield f"`{walk.knob.path}` was not walked to its ends: {walk.stopped}"


def together(pair: Pair) -> Iterator[str]:
    """Yields what is told of two params together."""
    for meeting in pair.meetings[:_PLACES]:
        a, b = (valued(knob, v) for knob, v in zip((pair.one, pair.other), meeting.values, strict=True))
        told = first_few([change.text for change in meeting.changes], _TOLD, "; and {} more", "; ")
        yield f"at `{pair.one.path} = {a}` with `{pair.other.path} = {b}` {told}"
    if len(pair.meetings) > _PLACES:
        more = counted(len(pair.meetings) - _PLACES, "other pair")
        yield f"`{pair.one.path}` with `{pair.other.path}`: {more} of values at which the kind is another"


def summary(found: Ranges) -> str:
    """Returns what was walked in one line, and that nobody looked between the values."""
    if not found.walks and not found.left:
        return "no param has a range of numbers, so there is nothing to walk"
    places = sum(len(walk.turns) for walk in found.walks)
    tried = sum(len(walk.tried) for walk in found.walks)
    kinds = "one kind throughout" if all(walk.ok for walk in found.walks) else "one kind as far as that was"
    if places:
        kinds = f"{counted(places, 'place')} where the kind changes"
    whole = sum(not walk.stopped for walk in found.walks)
    parts = [f"{counted(whole, 'param')} walked from end to end, {kinds}, {found.seconds:.1f} s"]
    if whole < len(found.walks):
        parts.append(f"{counted(len(found.walks) - whole, 'param')} not walked to its ends")
    if tried:
        parts.append(
            f"this holds for the {tried} values that were tried, not for what lies between two of them"
        )
    counts = [walk.knob.path for walk in found.walks if walk.declared]
    if counts:
        does = "changes" if len(counts) == 1 else "change"
        parts.append(f"{first_few([f'`{path}`' for path in counts], 6)} {does} which parts there are")
    if found.left:
        parts.append(f"{counted(len(found.left), 'param')} not walked: they take too long")
    if found.pairs or found.untried:
        values = sum(pair.tried for pair in found.pairs)
        whole = sum(not pair.stopped for pair in found.pairs)
        left = len(found.pairs) - whole + found.untried
        parts.append(
            f"{counted(whole, 'pair')} of params tried at the ends and halfway, at {values} pairs of values"
            + f", {counted(left, 'pair')} not or not at all of them" * bool(left)
        )
    return "; ".join(parts)


def described(name: str, found: Ranges) -> dict[str, Any]:
    return {
        "file": name,
        "ok": found.ok,
        "walked": [_walked(walk) for walk in found.walks],
        "left": [knob.path for knob in found.left],
        "pairs": [
            {
                "params": [pair.one.path, pair.other.path],
                "turns": [asdict(meeting) for meeting in pair.meetings],
                "tried": pair.tried,
                "stopped": pair.stopped,
            }
            for pair in found.pairs
        ],
        "pairs_left": found.untried,
        "seconds": round(found.seconds, 3),
    }


def _walked(walk: Walk) -> dict[str, Any]:
    knob = walk.knob
    return {
        "param": knob.path,
        "unit": knob.unit,
        "written": knob.value,
        "range": knob.range,
        "ok": walk.ok,
        "turns": [
            {
                "before": turn.before,
                "value": turn.after,
                "message": sentence(walk, turn),
                "changes": [asdict(change) for change in turn.changes],
                "fixes": [asdict(remedy) for remedy in turn.remedies],
            }
            for turn in walk.turns
        ],
        "declared": walk.declared,
        "tried": len(walk.tried),
        "stopped": walk.stopped,
        "seconds": round(walk.seconds, 3),
    }


def findings(found: Ranges, source: SourceFile) -> list[Diagnostic]:
    """Returns a warning for each place where the kind changes, at the param, with the first edit that keeps
    it as its fix; and one for each param that was not walked to its ends.
    """
    told = [_finding(walk, turn, source) for walk in found.walks for turn in walk.turns]
    stopped = [(walk.knob, walk.stopped) for walk in found.walks if walk.stopped]
    stopped += [(knob, "there was no time for it") for knob in found.left]
    for knob, why in stopped:
        told.append(Diagnostic(_CODE, f"`{knob.path}` was not walked to its ends: {why}", knob.span))
    return told


def _finding(walk: Walk, turn: Turn, source: SourceFile) -> Diagnostic:
    fixes = [
        Fix(remedy.title, (Edit(Span(source, *remedy.edit[:2]), remedy.edit[2]),)) for remedy in turn.remedies
    ]
    label = f"up to {valued(walk.knob, turn.before)} it is of the kind that it has as written"
    more = tuple(f"or {fix.title}" for fix in fixes[1:])
    text = sentence(walk, turn)
    return Diagnostic(_CODE, text, walk.knob.span, label, hints=more, fix=fixes[0] if fixes else None)


# --- What would keep the kind: a call that is stated, or a range that ends before.

Compiling = Callable[[SourceFile, Mapping[str, float]], Compiled]


def with_remedies(
    source: SourceFile, knob: Knob, turns: tuple[Turn, ...], compiling: Compiling
) -> list[Turn]:
    """Returns the turns with edits that were tried: a statement of how a call is read, which keeps the
    solution as it is, and for the nearest on each side a shorter range.
    """
    written = float(knob.value)
    nearest = {
        min(side, key=lambda t: abs(t.after - written)).after
        for side in ([t for t in turns if t.after < written], [t for t in turns if t.after > written])
        if side
    }
    made = []
    for turn in turns:
        remedies = [*_stated(source, knob, turn, compiling)]
        if turn.after in nearest and (ended := _ended(source, knob, turn, compiling)):
            remedies.append(ended)
        made.append(replace(turn, remedies=tuple(remedies)))
    return made


def _edited(source: SourceFile, remedy: Remedy) -> SourceFile:
    start, end, text = remedy.edit
    return SourceFile(source.name, source.text[:start] + text + source.text[end:])


def _stated(source: SourceFile, knob: Knob, turn: Turn, compiling: Compiling) -> Iterator[Remedy]:
    kinds = {change.kind for change in turn.changes}
    if not kinds & {"reading", "jump"}:
        return
    wanted = {change.line for change in turn.changes if change.kind == "reading"}
    as_written = compiling(source, {})
    calls = [] if as_written.model is None else [r.span for r in as_written.model.readings]
    here = [c for c in calls if c.source.name == source.name and (not wanted or c.line in wanted)]
    base = look(as_written, float(knob.value))
    for call in here[:_CALLS]:
        for text in _statements(call.text):
            remedy = Remedy(f"write `{text}`, which has one meaning", (call.start, call.end, text))
            if _keeps(_edited(source, remedy), knob, turn, base, compiling):
                yield remedy
                break


def _statements(call: str) -> Iterator[str]:
    """Yields an ambiguous call with each of its meanings stated."""
    if (match := _AMBIGUOUS.fullmatch(call.strip())) is None or "ccw" in call or "inside" in call:
        return
    word = "ccw" if match[1] == "angle" else "inside"
    value = f", {match['value'].strip()}" if match["value"] else ""
    for stated in ("true", "false"):
        yield f"{match[1]}({match['things'].strip()}{value}, {word}: {stated})"


def _keeps(source: SourceFile, knob: Knob, turn: Turn, base: Look, compiling: Compiling) -> bool:
    """Tells whether an edited program solves as before at the value as written, and does not change there."""
    now = look(compiling(source, {}), base.value)
    if not now.is_solved or now.errors or now.places != base.places:
        return False
    if len(now.spots) and abs(now.spots - base.spots).max() > _STILL:
        return False
    before, after = (look(compiling(source, {knob.path: v}), v, now) for v in (turn.before, turn.after))
    if not (before.is_solved and after.is_solved) or before.places != after.places:
        return False
    was = {change.key for change in turn.changes}
    moved = abs(after.spots - before.spots).max() if len(after.spots) else 0.0
    return not any(c.key in was for c in differences(before, after)) and bool(moved < 0.02)


def _ended(source: SourceFile, knob: Knob, turn: Turn, compiling: Compiling) -> Remedy | None:
    """Returns a range that ends before a turn."""
    is_low, at = turn.after < float(knob.value), knob.span
    if at is None or at.source.name != source.name:
        return None
    params = (node for node in ast.walk(parser.parse(source).module) if isinstance(node, ast.Param))
    declared = next((p for p in params if (p.span.start, p.span.end) == (at.start, at.end)), None)
    domain = declared and declared.domain
    if not isinstance(domain, ast.Range) or domain.exclusive or turn.before == knob.value:
        return None
    end = (domain.start if is_low else domain.end).span
    text = valued(knob, turn.before)
    way = "begin" if is_low else "end"
    remedy = Remedy(f"let the range of `{knob.path}` {way} at {text}", (end.start, end.end, text))
    then = compiling(_edited(source, remedy), {})
    low, high = next((k.range or (0, 0) for k in then.knobs if k.path == knob.path), (0.0, 0.0))
    is_there = abs((low if is_low else high) - turn.before) < 1e-9 * max(1.0, abs(turn.before))
    return remedy if then.ok and is_there else None


def turned(compiled: Compiled, seconds: float = LONGEST) -> list[Diagnostic]:
    """Returns what changes kind over the ranges of the params of a program, if it is ok."""
    asked = compiled.asked
    if asked is None or not compiled.ok:
        return []
    job = SweepJob(asked.source.name, asked.source.text, asked.world, asked.settings)
    return findings(ranges(job, compiled.knobs, seconds=seconds), asked.source)
