"""Parts move whole: what is drawn in a part of which constraints name one thing keeps its place in it, and no
more parts change inside than have to.
"""

from __future__ import annotations

import random
from collections.abc import Collection
from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.building.lower import Lowered, Solved, lower
from aidl_lang.common.source import SourceFile
from aidl_lang.interp import interpret
from aidl_lang.solver import Settings, Status, solve
from aidl_lang.solver.conflicts import nearby_solution
from tests.amount import tries

MOVED = 1e-6


def picture(seed: int, most: int = 5) -> tuple[str, int]:
    """Returns a program and its number of beams. Its constraints hold in a picture it was made from; what
    is drawn is off, and each beam has to stretch from one part to another.
    """
    draw = random.Random(seed)
    count = draw.randint(2, most)
    places = [(draw.randint(-9, 9) * 10, draw.randint(-9, 9) * 10) for _ in range(count)]
    widths = [draw.randint(4, 12) for _ in range(count)]
    lines, stated = ["assembly a {"], [f"p0.center == ({places[0][0]}, {places[0][1]})"]
    for i in range(count):
        x, y = places[i][0] + draw.randint(-8, 8), places[i][1] + draw.randint(-8, 8)
        dot = f"dot = circle(center: ({x}, {y}), radius: 1)"
        nested = draw.choice(
            [
                f"drawing decal {{ {dot}; way = line(({x - 1}, {y}), ({x}, {y})) }}",
                f"hole eye {{ rim = circle(center: ({x - 1}, {y}), radius: 1) }}",
                f"drawing decal {{ drawing inner {{ {dot} }} }}",
                f"drawing decal {{ {dot} }} constrain decal.dot.center == body.center",
            ]
        )
        lines.append(
            f"solid p{i} {{ body = rectangle(center: ({x}, {y}), width: {widths[i]}, height: 6); {nested} }}"
        )
        if i:
            j = draw.randrange(i)
            (ax, ay), (bx, by) = places[i], places[j]
            left, right = ax - widths[i] / 2, bx + widths[j] / 2
            stated.append(
                draw.choice(
                    [
                        f"p{i}.left == p{j}.right + {left - right}; p{i}.top == p{j}.top + {ay - by}",
                        f"p{i}.body.center == p{j}.body.center + ({ax - bx}, {ay - by})",
                        f"p{i}.center == p{j}.center + ({ax - bx}, {ay - by})",
                    ]
                )
            )
    beams = 0
    for _ in range(draw.randint(0, 2)):
        a, b = sorted(draw.sample(range(count), 2), key=lambda k: places[k])
        if places[b][0] - places[a][0] >= 10:
            lines.append(f"solid beam{beams} {{ bar = rectangle(width: guess(5), height: 2) }}")
            stated.append(
                f"beam{beams}.left == p{a}.center_x; beam{beams}.right == p{b}.center_x; "
                f"beam{beams}.bottom == p{a}.top"
            )
            beams += 1
    return "\n".join([*lines, "constrain {", *stated, "}", "}"]), beams


def solved(text: str) -> Solved:
    program, _ = pipeline.front(SourceFile("a.aidl", text))
    return solve(lower(interpret(program).model))


def moved_inside(solution: Solved) -> set[str]:
    """Returns the parts in which something moved against their frame."""
    found = set()
    problem = solution.problem
    for unknown, before, after in zip(problem.unknowns, problem.initial, solution.values, strict=True):
        part = unknown.path.split(".")[1]
        is_frame = unknown.frame_of is not None and unknown.frame_of.path == f"a.{part}"
        if not is_frame and abs(before - after) > MOVED:
            found.add(part)
    return found


def cost(parts: Collection[str]) -> tuple[int, int]:
    """Returns the number of rigid parts among these, which are not torn to spare a beam, and of beams."""
    beams = sum(part.startswith("beam") for part in parts)
    return len(parts) - beams, beams


def least_inside(problem: Lowered, parts: list[str]) -> tuple[int, int]:
    """Returns the least cost of parts whose inside has to move, by trying all sets of them."""
    hard = range(len(problem.holder))
    sets = [chosen for count in range(len(parts) + 1) for chosen in combinations(parts, count)]
    for chosen in sorted(sets, key=cost):
        start = {
            i: float(problem.initial[i])
            for i, u in enumerate(problem.unknowns)
            if (u.frame_of is not None and u.frame_of.path.count(".") == 1)
            or (u.path.split(".")[1] in chosen and not u.kept)
        }
        if nearby_solution(problem, Settings(), hard, start) is not None:
            return cost(chosen)
    raise AssertionError("no set of parts will do")


@given(st.integers(0, 1_000_000))
@tries(80)
def test_parts_move_whole(seed: int) -> None:
    text, beams = picture(seed)
    solution = solved(text)
    assert solution.status is Status.SOLVED
    assert moved_inside(solution) == {f"beam{i}" for i in range(beams)}


@given(st.integers(0, 1_000_000))
@tries(60)
def test_as_few_parts_as_possible_change_inside(seed: int) -> None:
    text, _ = picture(seed, most=3)
    solution = solved(text)
    parts = sorted({u.path.split(".")[1] for u in solution.problem.unknowns})
    assert cost(moved_inside(solution)) == least_inside(solution.problem, parts)
