"""Pictures that are known beforehand: what is said of them is drawn, from guesses that are off, in any order.

`python -m tests.property.test_pictures 1000` counts how often, over that many random pictures.
"""

from __future__ import annotations

import json
import random
import sys
from collections import Counter
from collections.abc import Iterator
from typing import Any

from hypothesis import given, note
from hypothesis import strategies as st

import aidl_lang
from tests.property.pictures import Picture, picture
from tests.property.test_model import TOLERANCE, apart, document, profile

MEANT = ("true", "told to be free", "rides along")
"""What may become of a picture."""
CHANCES = st.integers(0, 10**6).map(random.Random)


@given(CHANCES)
@profile(60)
def test_a_picture_that_is_determined_is_the_true_one(chance: random.Random) -> None:
    """In the rest it is told what is free, or something rides along of which nobody said where it stands."""
    true = picture(chance)
    note(true.text())
    assert outcome(true) in MEANT


@given(CHANCES)
@profile(20)
def test_a_picture_that_is_right_already_stays(chance: random.Random) -> None:
    """Whether it is determined or not."""
    true = picture(chance).exact
    note(true.text())
    model = aidl_lang.compile(true.text())
    assert model.status == "solved"
    assert not model.changed
    assert off(document(model), true) < 1e-9


@given(CHANCES)
@profile(25)
def test_the_order_of_a_picture_does_not_matter(chance: random.Random) -> None:
    true = picture(chance)
    one, other = true.text(), true.text(chance)
    note(one)
    note(other)
    assert apart(document(aidl_lang.compile(one)), document(aidl_lang.compile(other))) < TOLERANCE


def outcome(true: Picture) -> str:
    """What became of a picture, in words."""
    model = aidl_lang.compile(true.text())
    if model.status != "solved":
        return model.status
    if model.changed:
        return "sizes changed"
    if model.solved.degrees:
        return "told to be free" if model.solved.motions else "free and not told"
    if off(document(model), true) < TOLERANCE:
        return "true"
    return "rides along" if true.unnamed else "not meant"


def off(found: dict[str, Any], true: Picture) -> float:
    """How far a coordinate or a size of a solved picture is from the true one, at most."""
    solved = dict(_drawn(found["root"]))
    return max(
        abs(x - y) for path, values in true.truth.items() for x, y in zip(values, solved[path], strict=True)
    )


def _drawn(structure: dict[str, Any]) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Centre and size of each geometry by its path."""
    for name, geometry in structure["geometry"].items():
        values = geometry.get("params", geometry)
        match geometry["type"]:
            case "circle":
                size = (2 * values["radius"], 2 * values["radius"])
            case "slot":
                size = (values["length"], values["width"])
            case _:
                size = (values["width"], values["height"])
        yield f"{structure['path']}.{name}", (*values["center"], *size)
    for child in structure["structures"]:
        yield from _drawn(child)


if __name__ == "__main__":
    counts: Counter[str] = Counter()
    for seed in range(int(sys.argv[1])):
        counts[word := outcome(picture(random.Random(seed)))] += 1
        if word not in MEANT:
            print(f"seed {seed}: {word}", flush=True)
    print(json.dumps(counts))
