"""The stand-in for `manifold3d` against that, on the same inputs."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path
from typing import Any

import manifold3d
import pytest

from web.tests import booleans
from web.tests.places import Run

pytestmark = pytest.mark.slow


def polygon(random: random.Random) -> list[tuple[float, float]]:
    """A star, whose outline crosses itself now and then."""
    x, y, size = random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0.5, 25)
    count, turns = random.randint(3, 40), random.choice((1, 1, 1, 2, -1))
    return [
        (
            x + size * random.uniform(0.4, 1) * math.cos(2 * math.pi * turns * k / count),
            y + size * random.uniform(0.4, 1) * math.sin(2 * math.pi * turns * k / count),
        )
        for k in range(count)
    ]


def inputs() -> list[dict[str, Any]]:
    source = random.Random(7)
    return [
        {
            "a": [polygon(source) for _ in range(source.randint(1, 6))],
            "b": [polygon(source) for _ in range(source.randint(1, 4))],
            "rule": ("EvenOdd", "NonZero", "Positive")[k % 3],
            "by": source.uniform(0.1, 3),
        }
        for k in range(60)
    ]


def test_the_standin_gives_what_manifold3d_gives(run: Run, tmp_path: Path) -> None:
    given, made = tmp_path / "given.json", tmp_path / "made.json"
    given.write_text(json.dumps(inputs()))
    here = Path(__file__).parent
    run(here / "standin.py", given, made, here)
    for number, (found, each) in enumerate(zip(json.loads(made.read_text()), inputs(), strict=True)):
        wanted = json.loads(json.dumps(booleans.told(manifold3d, each)))
        solid, known = found.pop("solid"), wanted.pop("solid")
        assert found == wanted, number
        assert solid["empty"] == known["empty"]
        if not known["empty"]:  # the package's meshes have single precision
            assert solid["volume"] == pytest.approx(known["volume"], rel=1e-4, abs=0.01)
            assert solid["box"] == pytest.approx(known["box"], abs=1e-3)


def test_what_it_is_not_made_for_is_refused(run: Run, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "import manifold3d, numpy as np\n"
        "try:\n    manifold3d.CrossSection([np.zeros((4, 3))])\n"
        "except TypeError as reason:\n    assert 'two numbers' in str(reason)\n"
        "else:\n    raise AssertionError('it was taken')\n"
    )
    run(script)
