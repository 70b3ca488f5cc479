"""What is said of programs that cannot hold, and of such as only seem so (see `contradictions`)."""

from __future__ import annotations

import pytest

from tests.amount import tried
from tests.property.contradictions import Program, badly_guessed, broken_program, faults, guess_fault

BROKEN = [p for p in map(broken_program, range(40)) if p is not None][: tried(16)]


@pytest.mark.parametrize("program", BROKEN, ids=range(len(BROKEN)))
def test_a_broken_number_is_found_and_mended(program: Program) -> None:
    assert list(faults(program)) == []


@pytest.mark.parametrize("seed", range(tried(16)))
def test_a_bad_guess_is_no_contradiction(seed: int) -> None:
    assert guess_fault(badly_guessed(seed)) is None
