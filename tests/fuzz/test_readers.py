"""Files that broke their reader once, and a few changed ones of each kind."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.amount import some
from tests.fuzz.readers import FILES, READERS, changed, finding, made, samples


@pytest.mark.parametrize("path", sorted(FILES.iterdir()), ids=lambda path: path.name)
def test_nothing_breaks_its_reader_any_more(path: Path) -> None:
    assert finding(path.suffix.removeprefix("."), path.read_bytes()) == ""


@pytest.mark.parametrize("kind", sorted(READERS))
def test_changed_files_are_read_or_told(kind: str) -> None:
    for data in samples(kind):
        assert finding(kind, data) == ""
    for seed in some([*range(40)], 12 if kind == "rpc" else 6):
        data = changed(samples(kind), random.Random(seed))
        assert finding(kind, data) == "", seed


def test_a_file_follows_from_its_seed() -> None:
    assert [made(seed) for seed in range(8)] == [made(seed) for seed in range(8)]
