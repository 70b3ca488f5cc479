"""What is said of programs that cannot hold, and of such as only seem so (see `contradictions`)."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from tests.amount import tried
from tests.property.contradictions import (
    Program,
    badly_guessed,
    broken_program,
    centers,
    compiled,
    faults,
    guess_fault,
    picture,
)

BROKEN = [p for p in map(broken_program, range(40)) if p is not None][: tried(16)]


@pytest.mark.parametrize("program", BROKEN, ids=range(len(BROKEN)))
def test_a_broken_number_is_found_and_mended(program: Program) -> None:
    assert list(faults(program)) == []


@pytest.mark.parametrize("seed", range(tried(16)))
def test_a_bad_guess_is_no_contradiction(seed: int) -> None:
    assert guess_fault(badly_guessed(seed)) is None


@pytest.mark.parametrize("seed", range(tried(100)))
def test_what_is_said_of_a_picture_is_drawn(seed: int) -> None:
    """From first guesses that are off, in any order; and what is right already stays."""
    program, truth = picture(seed, off=20)
    order = random.Random(seed).sample(program.statements, len(program.statements))
    for each in (program, replace(program, statements=tuple(order)), picture(seed, off=0)[0]):
        found = compiled(each)
        assert found.status == "solved"
        assert found.model is not None
        assert not found.model.changed
        drawn = centers(found)
        assert {name: pytest.approx(center, abs=1e-6) for name, center in truth.items()} == drawn, each.text
