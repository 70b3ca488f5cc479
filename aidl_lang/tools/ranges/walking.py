"""Walks a param from the value as written to both ends of its range, and finds where the kind changes.

Values are tried at equal distances, and between two of them where the boxes of openings or bodies would meet
if all moved evenly. Where two neighbours differ in kind, and where a point moves much less evenly than others
do, the way between them is halved until it is a thousandth of the range. What a point moves by then while all
that the program states goes on evenly is a jump: the solver takes another solution.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise, product

import numpy as np
from numpy.typing import NDArray

from aidl_lang import pipeline
from aidl_lang.building.lower import lower
from aidl_lang.building.model import Knob
from aidl_lang.common.processes import Limit
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import SourceFile
from aidl_lang.compiled import Compiled
from aidl_lang.solver import Memory, Problem, Settings, Status, solve
from aidl_lang.tools.ends import Course, SweepJob, allowed, checked, followed, is_whole, rounded
from aidl_lang.tools.ranges.looks import Change, Look, differences, look, may_meet, moves
from aidl_lang.tools.sweeping.bundle import BROKEN

FINEST = 1e-3
"""Accuracy of a place, as a part of the range."""
LONGEST = 300.0
"""Seconds for all params."""
_A_KNOB = 60.0
"""Seconds for one param, after which no value is begun."""
_STEPS = {300: 20, 800: 12, math.inf: 7}
"""Values that are tried at equal distances in programs of at most so many names."""
_AT_LEAST = 3
"""Values that are tried on each side of the one as written, if there are so many."""
_MOST = 150
"""Values that are tried at the most."""
_DEEPEST = 3
"""How often a way is halved where something may pass between its ends."""
_UNEVEN = 0.55
"""What is left of the unevenness of a move on half of its way: 1/4 if smooth, 1/2 at a bend, 1 in a jump."""
_JUMP = 1e-3
"""The least jump, in sizes of the drawing or radians."""
_COARSE = frozenset(("error", "reading", "openings", "pieces", "contact", "warning"))
"""The kinds of changes that can be told between values far from each other: an edge may have been turned."""

Spot = tuple[tuple[str, float], ...]
"""Values of params by path."""


@record()
class Remedy:
    """An edit of the program that was tried: where it begins and ends in the text, and the new text."""

    title: str
    edit: tuple[int, int, str]


@record()
class Turn:
    """A place where the kind changes: the last value of the one, and the first of the other, seen from the
    value as written.
    """

    before: float
    after: float
    changes: tuple[Change, ...]
    remedies: tuple[Remedy, ...] = ()


@record()
class Walk:
    """What a param does on its way.

    declared  places where the parts themselves are others, as by a count
    tried     the values that were compiled
    stopped   why it was not walked to its ends; "" if it was
    """

    knob: Knob
    turns: tuple[Turn, ...] = ()
    declared: int = 0
    tried: tuple[float, ...] = ()
    stopped: str = ""
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        return not self.turns and not self.stopped


@record()
class Meeting:
    """Values of two params at which something is of another kind only together."""

    values: tuple[float, float]
    changes: tuple[Change, ...]


@record()
class Pair:
    """Two params, the values that were tried of both, and why no more were; "" if all were."""

    one: Knob
    other: Knob
    meetings: tuple[Meeting, ...] = ()
    tried: int = 0
    stopped: str = ""


@record()
class Ranges:
    """The walks of all params with a range, and pairs of them if that was asked for. `left`: those that were
    not walked, for want of time, and `untried` is the number of such pairs.
    """

    walks: tuple[Walk, ...]
    left: tuple[Knob, ...] = ()
    seconds: float = 0.0
    pairs: tuple[Pair, ...] = ()
    untried: int = 0

    @property
    def ok(self) -> bool:
        is_whole = not (self.left or self.untried) and all(walk.ok for walk in self.walks)
        return is_whole and not any(pair.meetings or pair.stopped for pair in self.pairs)


def has_way(knob: Knob) -> bool:
    """True for a param with a way to walk: a number with a range."""
    is_number = not isinstance(knob.value, bool | str) and not knob.choices
    return is_number and knob.range is not None and knob.low != knob.high


class OutOfSteps(Exception):  # noqa: N818 (it ends a walk, and is no error)
    """Raised where there are no more values to try, or no more time."""


class Walker:
    """Walks one param. `compiled` gives the outcome at a value."""

    def __init__(self, knob: Knob, compiled: Callable[[float], Compiled], until: float = math.inf) -> None:
        self.knob, self.compiled, self.until = knob, compiled, until
        self.low, self.high = knob.range or (0.0, 0.0)
        self.written = float(knob.value)
        self.looks: dict[float, Look] = {}
        self.turns: list[Turn] = []
        self.grid: list[float] = []
        self.declared = 0
        self.is_count = False

    @property
    def width(self) -> float:
        """The width of a way that is not halved any more."""
        if self.is_count:
            return 1.0
        return max(FINEST * (self.high - self.low), self.knob.step or 0.0) * (1 + 1e-6)

    def at(self, value: float) -> Look:
        if value not in self.looks:
            checkpoint()
            if len(self.looks) >= _MOST or time.monotonic() > self.until:
                raise OutOfSteps
            self.looks[value] = look(self.compiled(value), value, self.looks.get(self.written))
        return self.looks[value]

    def walk(self) -> str:
        """Walks both ways; returns why it stopped before the ends, or ""."""
        try:
            names = len(self.at(self.written).names)
            number = next(steps for most, steps in _STEPS.items() if names <= most)
            self.is_count = is_whole(self.knob) and self._breaks_between()
            ways = [self._way(end, number) for end in (self.low, self.high)]
            self.grid = sorted({self.written, *ways[0], *ways[1]})
            for way in ways:
                for a, b in pairwise([self.written, *way]):
                    self._between(a, b, 0)
            if not (self.is_count or self.knob.step):
                self._leaps()
        except OutOfSteps:
            return "it takes too long" if len(self.looks) < _MOST else f"{_MOST} values were tried"
        return ""

    def _breaks_between(self) -> bool:
        """Tells whether a number that is written whole may be nothing else."""
        aside = self.written + (0.5 if self.written < self.high else -0.5)
        return bool(self.at(aside).errors) or self.at(aside).names != self.at(self.written).names

    def _way(self, end: float, steps: int) -> list[float]:
        """Returns the values up to an end, outwards."""
        share = abs(end - self.written) / (self.high - self.low)
        number = max(_AT_LEAST, round(steps * share))
        way = [self.written + (end - self.written) * k / number for k in range(1, number)]
        way = [*map(self._short, way), allowed(self.knob, end)]
        return [value for value in dict.fromkeys(way) if abs(value - self.written) > 1e-9 * abs(end)]

    def _short(self, value: float) -> float:
        """Returns an allowed value near to one, of few digits."""
        if self.is_count:
            return float(round(value))
        unit = 10.0 ** math.floor(math.log10(5 * FINEST * (self.high - self.low)))
        return allowed(self.knob, round(value / unit) * unit)

    def _middle(self, a: float, b: float, share: float = 0.5) -> float | None:
        """Returns a value between two others, of as few digits as will do; None if there is none."""
        if abs(b - a) <= self.width:
            return None
        aim, room = a + share * (b - a), abs(b - a) * min(share, 1 - share) / 2
        if self.is_count or self.knob.step:
            found = self._short(aim)
        else:
            unit = 10.0 ** math.floor(math.log10(2 * room))
            found = rounded(round(aim / unit) * unit)
        return found if min(a, b) < found < max(a, b) else None

    def _between(self, a: float, b: float, depth: int) -> None:
        one, other = self.at(a), self.at(b)
        if changes := differences(one, other):
            middle = self._middle(a, b)
            if middle is None:
                self._turn(a, b, changes)
        else:
            share = may_meet(one, other) if depth < _DEEPEST else None
            middle = None if share is None else self._middle(a, b, share)
            self.declared += middle is None and one.names != other.names
        if middle is not None:
            self._between(a, middle, depth + 1)
            self._between(middle, b, depth + 1)

    def _turn(self, a: float, b: float, changes: Sequence[Change]) -> None:
        self.declared += self.at(a).names != self.at(b).names
        self.turns.append(Turn(a, b, tuple(changes)))  # this stays if there is no time to look closer
        jump = self._jump(a, b)
        kept = [c for c in changes if not (jump and c.kind == "edge") and self._lasts(c, a, b)]
        self.turns[-1:] = [Turn(a, b, (*jump, *kept))] if jump or kept else []

    def _lasts(self, change: Change, a: float, b: float) -> bool:
        """Tells whether a change is more than a warning for one value alone."""
        if change.kind != "warning":
            return True
        beyond = min(max(b + math.copysign(1.5 * self.width, b - a), self.low), self.high)
        found = self.at(self._short(beyond) if self.is_count or self.knob.step else beyond)
        return any(change.paths == (w.code,) and w.line == change.line for w in found.warnings.values())

    # --- Jumps

    def _leaps(self) -> None:
        values = [v for v in self.grid if self.at(v).is_solved]
        triples = list(zip(values, values[1:], values[2:], strict=False))
        uneven = [self._uneven(*triple)[1] for triple in triples]
        usual = float(np.median(uneven)) if uneven else 0.0
        for (a, m, b), far in zip(triples, uneven, strict=True):
            is_known = any(a <= min(t.before, t.after) and max(t.before, t.after) <= b for t in self.turns)
            if far > max(_JUMP, 4 * usual) and not is_known:
                self._descend(a, m, b)

    def _uneven(self, a: float, m: float, b: float) -> tuple[int, float]:
        """Returns the spot that moves the least evenly over three values, and by how much."""
        first, second = moves(self.at(a), self.at(m)), moves(self.at(m), self.at(b))
        if len(first) != len(second) or not len(first):
            return 0, 0.0
        share = (m - a) / (b - a)
        found = np.abs(first * (1 - share) - second * share)
        return int(found.argmax()), float(found.max())

    def _descend(self, a: float, m: float, b: float) -> None:
        """Halves the way around what moves unevenly as long as it stays so; notes a jump."""
        spot, uneven = self._uneven(a, m, b)
        while True:
            a, b = (a, m) if self._move(a, m, spot) >= self._move(m, b, spot) else (m, b)
            middle = self._middle(a, b)
            if middle is None:
                break
            m, then = middle, uneven
            spot, uneven = self._uneven(a, m, b)
            if not self.at(m).is_solved or uneven < max(_UNEVEN * then, _JUMP / 4):
                return
        near, away = sorted((a, b), key=lambda v: abs(v - self.written))
        if jump := self._jump(near, away):
            self.turns.append(Turn(near, away, jump))

    def _move(self, a: float, b: float, spot: int) -> float:
        by = moves(self.at(a), self.at(b))
        return abs(float(by[spot])) if len(by) else 0.0

    def _jump(self, a: float, b: float) -> tuple[Change, ...]:
        """Returns the jump between two neighbouring values; none if what moves is what the program states."""
        one, other = self.at(a), self.at(b)
        by = np.abs(moves(one, other))
        if self.is_count or self.knob.step or not len(by) or one.unknowns.keys() != other.unknowns.keys():
            return ()
        by[by < np.maximum(_JUMP, 8 * self._rates(one) * abs(b - a))] = 0.0
        far = int(by.argmax())
        gone = max((abs(x - other.unknowns[path]) for path, x in one.unknowns.items()), default=0.0)
        if not by[far] or gone < _JUMP * one.size or not self._stays(a, b, far):
            return ()
        is_read = any(change.kind == "reading" for change in differences(one, other))
        if not is_read and self._is_stated(a, b):
            return ()
        paths = tuple(dict.fromkeys(one.places[k] for k in np.argsort(-by)[: np.count_nonzero(by)].tolist()))
        told = f"`{paths[0]}` jumps by {by[far] * one.size:.3g} mm"
        if not is_read and self._goes_on(a, b, float(by[far])):
            told += ", though the solution before still holds"
        return (Change("jump", told, None, paths),)

    def _rates(self, like: Look) -> NDArray[np.float64]:
        """Returns how fast each spot moves as a rule."""
        ways = [(a, b) for a, b in pairwise(self.grid) if a in self.looks and b in self.looks]
        found = [
            np.abs(by) / (b - a)
            for a, b in ways
            if len(by := moves(self.at(a), self.at(b))) == len(like.spots)
        ]
        return np.median(found, axis=0) if found else np.zeros(len(like.spots))

    def _stays(self, a: float, b: float, spot: int) -> bool:
        """Tells whether what a spot moves is the same on an eighth of a way: it is no steep bend."""
        whole = self._move(a, b, spot)
        for _ in range(3):
            middle = (a + b) / 2
            if not self.at(middle).is_solved:
                return False
            a, b = (a, middle) if self._move(a, middle, spot) >= self._move(middle, b, spot) else (middle, b)
        return self._move(a, b, spot) > 0.8 * whole

    def _problem(self, value: float) -> Problem | None:
        """Returns the problem at the nearest value of the range; None if the program is wrong there."""
        built = self.compiled(min(max(value, self.low), self.high)).built
        return None if built is None else lower(built)

    def _is_stated(self, a: float, b: float) -> bool:
        """Tells whether a number that the program states jumps as well: a rounded one, or a choice."""
        way = b - a
        for aside in (0.0, 0.3):  # at a special value there may be less to compute
            one, other = self._problem(a - aside * way), self._problem(b + aside * way)
            third = self._problem(a - 8 * way if self.low <= a - 8 * way <= self.high else b + 8 * way)
            if one is None or other is None or third is None:
                return True
            if one.tape.op_list == other.tape.op_list == third.tape.op_list:
                break
        else:
            return True
        here, there = _numbers(other) - _numbers(one), _numbers(third) - _numbers(one)
        slack = 1e-6 * (1 + np.abs(_numbers(one)))
        return bool((np.abs(here) > np.abs(there) / 2 + slack).any())

    def _goes_on(self, a: float, b: float, far: float) -> bool:
        """Tells whether there is a solution at `b` beside that at `a`, which the jump leaves."""
        before, problem = self.at(a), self._problem(b)
        start = np.array(list(before.unknowns.values()))
        if problem is None or len(start) != len(problem.initial):
            return False
        found = solve(replace(problem, initial=start), replace(Settings(), explain=False))
        return found.status is Status.SOLVED and bool(
            np.abs(found.values - start).max() < 0.2 * far * before.size
        )


def _numbers(problem: Problem) -> NDArray[np.float64]:
    return np.concatenate((problem.tape.constants, problem.initial))


# --- Two params at a time, at the ends of their ranges and halfway there: what is of another kind then, and
# is not where one of them alone is turned.


def coarse(knob: Knob) -> list[float]:
    """Returns the ends of a range and what lies halfway, without the value as written."""
    written, (low, high) = float(knob.value), knob.range or (0.0, 0.0)
    aims = [low, (low + written) / 2, (high + written) / 2, high]
    values = [float(round(aim)) if is_whole(knob) else allowed(knob, aim) for aim in aims]
    return [value for value in dict.fromkeys(values) if abs(value - written) > 1e-9 * max(1.0, abs(written))]


def paired(one: Knob, other: Knob, compiled: Callable[[Spot], Compiled], until: float) -> Pair:
    """Tries two params together; the nearest values first."""
    looks: dict[Spot, Look] = {}

    def at(*spot: tuple[str, float]) -> Look:
        if spot not in looks:
            checkpoint()
            looks[spot] = look(compiled(spot), 0.0, looks.get(()))
        return looks[spot]

    def keys(*spot: tuple[str, float]) -> set[object]:
        return {change.key for change in differences(at(), at(*spot))}

    found: list[Meeting] = []
    tried = 0
    for a, b in sorted(
        product(coarse(one), coarse(other)), key=lambda ab: _far(one, ab[0]) + _far(other, ab[1])
    ):
        if time.monotonic() > until:
            return Pair(one, other, tuple(found), tried, "it takes too long")
        alone = keys((one.path, a)) | keys((other.path, b))
        both = differences(at(), at((one.path, a), (other.path, b)))
        tried += 1
        if new := tuple(c for c in both if c.kind in _COARSE and c.key not in alone):
            found.append(Meeting((a, b), new))
    return Pair(one, other, tuple(found), tried)


def _far(knob: Knob, value: float) -> float:
    low, high = knob.range or (0.0, 1.0)
    return abs(value - float(knob.value)) / (high - low)


# --- Each param is walked in a process.


def _compiling(job: SweepJob, source: SourceFile) -> Callable[[Spot], Compiled]:
    """Returns what compiles a program with some params set: it is checked once, and solved anew in part."""
    memory, known = Memory(), checked(job)
    return lambda spot: pipeline.compile(source, job.world, dict(spot), job.settings, (), memory, known)


def met(job: SweepJob, one: Knob, other: Knob, seconds: float = _A_KNOB) -> Pair:
    """Tries two params of a program that works as written together."""
    compiling = _compiling(job, SourceFile(job.name, job.text))
    return paired(one, other, compiling, time.monotonic() + seconds)


def walked(job: SweepJob, knob: Knob, seconds: float = _A_KNOB) -> Walk:
    """Walks a param of a program that works as written."""
    start, source = time.perf_counter(), SourceFile(job.name, job.text)
    compiling = _compiling(job, source)

    def compiled(value: float) -> Compiled:
        return compiling(((knob.path, value),))

    def other(changed: SourceFile, params: Mapping[str, float]) -> Compiled:
        return pipeline.compile(changed, job.world, params, job.settings)

    walker = Walker(knob, compiled, time.monotonic() + seconds)
    stopped = walker.walk()
    turns = tuple(sorted(walker.turns, key=lambda turn: (turn.after, turn.before)))
    if turns and time.monotonic() < walker.until:
        from aidl_lang.tools.ranges import with_remedies

        turns = tuple(with_remedies(source, knob, turns, other))
    tried = tuple(sorted(walker.looks))
    return Walk(knob, turns, walker.declared, tried, stopped, time.perf_counter() - start)


def ranges(
    job: SweepJob,
    knobs: Sequence[Knob],
    progress: Callable[[int, int], None] = lambda done, count: None,
    seconds: float = LONGEST,
    *,
    in_pairs: bool = False,
) -> Ranges:
    """Walks the params of a working program, side by side, and tries each two of them if `in_pairs`.
    `progress` is told how many are done, of how many.

    Raises Cancelled where nobody waits for it any more (see `common.running`).
    """
    start = time.monotonic()
    wanted = [knob for knob in knobs if has_way(knob)]
    if not wanted:
        return Ranges((), (), 0.0)
    twos = list(combinations(wanted, 2)) if in_pairs else []
    courses = [*(_alone(job, knob) for knob in wanted), *(_both(job, *two) for two in twos)]
    module, longest = "aidl_lang.tools.ranges.walking", _A_KNOB + job.seconds
    done, _ = followed(module, courses, longest, progress, start + seconds)
    walks = tuple(each for each in done if isinstance(each, Walk))
    pairs = tuple(each for each in done if isinstance(each, Pair))
    left = tuple(knob for knob in wanted if all(walk.knob is not knob for walk in walks))
    return Ranges(walks, left, time.monotonic() - start, pairs, len(twos) - len(pairs))


def _alone(job: SweepJob, knob: Knob) -> Course[Walk | Pair]:
    found = yield walked, job, knob
    return Walk(knob, stopped=BROKEN[found]) if isinstance(found, Limit) else replace(found, knob=knob)


def _both(job: SweepJob, one: Knob, other: Knob) -> Course[Walk | Pair]:
    found = yield met, job, one, other
    return Pair(one, other, stopped=BROKEN[found]) if isinstance(found, Limit) else found
