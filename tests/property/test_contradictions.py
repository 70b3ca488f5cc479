"""What is said of programs that cannot hold, and of such as only seem so: programs true of a drawing, and the
same with one number or one first guess made wrong.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Fix, apply_fixes
from aidl_lang.common.source import SourceFile
from aidl_lang.explaining.failures import Conflict
from tests.amount import some, tried

GAVE_WAY = frozenset({"N0601", "W0601", "W0602"})


@dataclass(frozen=True)
class Program:
    """
    things      declarations, with the place of each
    statements  constraints that are true of these places, one to a line
    broken      the number of the one that was made wrong
    """

    things: tuple[str, ...]
    statements: tuple[str, ...]
    broken: int = -1

    @property
    def text(self) -> str:
        lines = [*self.things, "constrain {", *(f"    {s}" for s in self.statements), "}"]
        return "drawing d {\n" + "".join(f"    {line}\n" for line in lines) + "}\n"

    @property
    def first_line(self) -> int:
        """Where the first statement stands."""
        return len(self.things) + 3


@dataclass(frozen=True)
class _Thing:
    name: str
    x: float
    y: float
    w: float
    h: float

    def placed(self, x: float, y: float, is_inside: bool = False) -> str:
        """Its declaration with another first guess of its place; `is_inside` a structure."""
        size = f"width: fixed({self.w:g}), height: fixed({self.h:g})"
        if is_inside:
            body = f"body = rectangle(center: fixed((0, 0)), {size})"
            return f"drawing {self.name} at ({x:g}, {y:g}) {{ {body} }}"
        return f"{self.name} = rectangle(center: ({x:g}, {y:g}), {size})"


@dataclass(frozen=True)
class _Stated:
    """A statement with `{}` in the place of its number. It ties `a` and `b` together along `axis`, or bounds
    or measures what other statements place (no axis).
    """

    form: str
    value: float
    a: str
    b: str
    axis: str = ""

    def says(self, value: float) -> str:
        return self.form.format(f"{value:.12g}")


def _relations(a: _Thing, b: _Thing, rng: random.Random) -> Iterator[_Stated]:
    """Statements that are true of two things, `b` to the right of `a`."""
    dx, dy = b.x - a.x, b.y - a.y
    ends = a.name, b.name
    yield _Stated(f"{b.name}.center.x - {a.name}.center.x == {{}}", dx, *ends, "x")
    yield _Stated(f"{b.name}.center.y - {a.name}.center.y == {{}}", dy, *ends, "y")
    yield _Stated(f"horizontal_distance({a.name}.center, {b.name}.center) == {{}}", abs(dx), *ends, "x")
    yield _Stated(f"distance({a.name}.center, {b.name}.center) == {{}}", math.hypot(dx, dy), *ends)
    gap = (b.x - b.w / 2) - (a.x + a.w / 2)
    if gap > 0:
        yield _Stated(f"{b.name}.right_of({a.name}, gap: {{}})", gap, *ends, "x")
        yield _Stated(f"{b.name}.left >= {a.name}.right + {{}}", gap - rng.randint(0, 2), *ends)
    rise = (b.y - b.h / 2) - (a.y + a.h / 2)
    if rise > 0:
        yield _Stated(f"{b.name}.above({a.name}, gap: {{}})", rise, *ends, "y")


def _true_statements(seed: int) -> tuple[list[_Thing], list[_Stated]]:
    """Things, and what is true of them: all are placed, and some more is said."""
    rng = random.Random(seed)
    bounds = ((-40, 40), (-30, 30), (4, 20), (4, 20))
    things = [_Thing(f"p{k}", *(float(rng.randint(*b)) for b in bounds)) for k in range(rng.randint(3, 5))]
    things = [replace(thing, x=thing.x + 60 * k) for k, thing in enumerate(things)]
    first = things[0]
    stated = [
        _Stated("p0.center.x == {}", first.x, "p0", "", "x"),
        _Stated("p0.center.y == {}", first.y, "p0", "", "y"),
    ]
    for k, b in enumerate(things[1:], 1):
        stated += list(_relations(rng.choice(things[:k]), b, rng))[:2]
    for _ in range(rng.randint(1, 4)):
        a, b = sorted(rng.sample(things, 2), key=lambda thing: thing.x)
        more = rng.choice(list(_relations(a, b, rng)))
        if more.form not in [each.form for each in stated]:
            stated.append(more)
    rng.shuffle(stated)
    return things, stated


def broken_program(seed: int) -> Program | None:
    """A program with one number changed by a few millimetres; None where that contradicts nothing."""
    things, stated = _true_statements(seed)
    rng = random.Random(-seed - 1)
    number = rng.randrange(len(stated))
    broken = stated[number]
    more = ">=" in broken.form or broken.value < 12
    by = rng.choice([3, 5, 7, 11]) * (1 if more else rng.choice([-1, 1]))
    others = [each for each in stated if each is not broken]
    if not all(_are_tied(broken.a, broken.b, axis, others) for axis in broken.axis or "xy"):
        return None
    lines = [each.says(each.value + by if each is broken else each.value) for each in stated]
    return Program(tuple(thing.placed(thing.x, thing.y) for thing in things), tuple(lines), number)


def _are_tied(a: str, b: str, axis: str, stated: Iterable[_Stated]) -> bool:
    """Whether statements leave two things no way to move against each other along an axis."""
    reached, ties = {a}, [{each.a, each.b} for each in stated if each.axis == axis]
    while further := [tie for tie in ties if tie & reached and not tie <= reached]:
        reached.update(*further)
    return b in reached


def picture(seed: int, off: float) -> tuple[Program, dict[str, tuple[float, float]]]:
    """What is true of a drawing, with first guesses that are so far off at most; and the true centres."""
    things, stated = _true_statements(seed)
    rng = random.Random(seed)
    declared = [
        thing.placed(*(at + rng.uniform(-off, off) for at in (thing.x, thing.y)), rng.random() < 0.5)
        for thing in things
    ]
    truth = {thing.name: (thing.x, thing.y) for thing in things}
    return Program(tuple(declared), tuple(each.says(each.value) for each in stated)), truth


def centers(found: pipeline.Compiled) -> dict[str, tuple[float, float]]:
    """Of the rectangles that are drawn, by their names or by those of what they are in."""
    return {
        g.path.split(".")[1]: g.values["center"]
        for g in found.model.root.walk_geometry()
        if g.type == "rectangle"
    }


# --- Judgement -------------------------------------------------------------------------------------


def compiled(program: Program | str) -> pipeline.Compiled:
    text = program if isinstance(program, str) else program.text
    return pipeline.compile(SourceFile("part.aidl", text))


def is_good(text: str) -> bool:
    found = compiled(text)
    return found.ok and not GAVE_WAY.intersection(d.code for d in found.diagnostics)


def offered(conflict: Conflict) -> Iterator[Fix]:
    yield from (party.fix for party in conflict.parties if party.fix is not None)
    yield from (given.fix for given in conflict.givens)


def faults(program: Program) -> Iterator[str]:
    """What is wrong with the explanation of a broken program."""
    found = compiled(program)
    conflicts = found.conflicts()
    if not conflicts:
        yield f"no conflict: {found.status}"
        return
    for conflict in conflicts:
        members = {party.span.line - program.first_line for party in conflict.parties}
        if program.broken not in members:
            yield "the broken statement is not among them"
        for member in sorted(members):
            rest = [statement for n, statement in enumerate(program.statements) if n in members - {member}]
            if compiled(replace(program, statements=tuple(rest))).status != "solved":
                yield f"not minimal: fails without `{program.statements[member]}`"
    source = conflicts[0].parties[0].span.source
    fixes = [fix for conflict in conflicts for fix in offered(conflict)]
    texts = [apply_fixes(source, [replace(found.diagnostics[0], fix=fix)])[0] for fix in fixes]
    if len(conflicts) == 1 and not all(map(is_good, texts)):
        yield "a number that is offered does not solve"
    mended = program.text
    for _ in conflicts:  # what one fix mends may have had a share in others
        text = SourceFile("part.aidl", mended)
        left = pipeline.compile(text).diagnostics
        mended, _ = apply_fixes(text, left)
    if not is_good(mended):
        yield "the fixes do not mend it"
    if not any(map(is_good, [*texts, mended])):
        yield "no number restores it"


def badly_guessed(seed: int) -> Program:
    """Distances that are true of points, which are written somewhere else."""
    rng = random.Random(seed)
    points = [(float(rng.randint(-50, 50)), float(rng.randint(-50, 50))) for _ in range(rng.randint(2, 4))]
    guesses = [(float(rng.randint(-80, 80)), float(rng.randint(-80, 80))) for _ in points]
    things = [f"p{k} = circle(center: ({x:g}, {y:g}), radius: fixed(2))" for k, (x, y) in enumerate(guesses)]
    stated = [f"p0.center == ({points[0][0]:g}, {points[0][1]:g})"]
    for k, (x, y) in enumerate(points[1:], 1):
        a = rng.randrange(k)
        ax, ay = points[a]
        stated.append(f"distance(p{k}.center, p{a}.center) == {math.hypot(x - ax, y - ay):.12g}")
        stated.append(
            rng.choice(
                [
                    f"p{k}.center.x - p{a}.center.x == {x - ax:g}",
                    f"p{k}.center.y {'>=' if y >= ay else '<='} p{a}.center.y + {round((y - ay) / 2)}",
                    f"vertical_distance(p{k}.center, p{a}.center) == {abs(y - ay):g}",
                ]
            )
        )
    return Program(tuple(things), tuple(stated))


def guess_fault(program: Program) -> str | None:
    """What is wrong with the answer to a program that can hold."""
    found = compiled(program)
    if found.status == "solved":
        return None
    codes = sorted({d.code for d in found.diagnostics if d.is_error})
    if codes == ["E0602"] and any(d.fix for d in found.diagnostics):
        return None
    return f"{codes}"


# --- The tests -----------------------------------------------------------------------------------------

BROKEN = some([p for p in map(broken_program, range(40)) if p is not None], 16)


@pytest.mark.parametrize("program", BROKEN, ids=range(len(BROKEN)))
def test_a_broken_number_is_found_and_mended(program: Program) -> None:
    assert list(faults(program)) == []


@pytest.mark.parametrize("seed", range(tried(16)))
def test_a_bad_guess_is_no_contradiction(seed: int) -> None:
    assert guess_fault(badly_guessed(seed)) is None


@pytest.mark.parametrize("seed", range(tried(40)))
def test_what_is_said_of_a_picture_is_drawn(seed: int) -> None:
    """From first guesses that are off, in any order; and what is right already stays."""
    program, truth = picture(seed, off=20)
    order = random.Random(seed).sample(program.statements, len(program.statements))
    for each in (program, replace(program, statements=tuple(order)), picture(seed, off=0)[0]):
        found = compiled(each)
        assert found.status == "solved"
        assert not found.model.changed
        drawn = centers(found)
        assert {name: pytest.approx(center, abs=1e-6) for name, center in truth.items()} == drawn, each.text
