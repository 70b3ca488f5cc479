"""Sweeps from Python."""

from __future__ import annotations

from pathlib import Path

import pytest

import aidl_lang
from aidl_lang import AidlError
from tests.sweep.here import PLATE


def test_a_sweep_is_an_iterator_and_a_table(tmp_path: Path) -> None:
    with aidl_lang.sweep(
        PLATE,
        {"width": range(40, 121, 40), "style": ["square"]},
        output=tmp_path / "{width}.svg",
        jobs=1,
        theme="ink",
    ) as swept:
        assert (len(swept), repr(swept)) == (3, "<aidl_lang.Sweep 0 of 3 variants>")
        first = next(iter(swept))
        assert (first.number, first.params, first.ok) == (1, {"width": 40.0, "style": "square"}, True)
        assert [row.number for row in swept.results] == [1, 2, 3]
        assert [row.measures["width"] for row in swept.results] == [40, 80, 120]
        (bad,) = swept.failures
        assert bad.message == "E0604 line 10: assertion failed: it fits the sheet (120 is not < 110)"
    table = swept.to_arrow()
    assert table.column("drawn_width").to_pylist() == [40, 80, 120]
    frame = swept.to_pandas()
    assert list(frame[frame.ok].width) == [40.0, 80.0]
    direct = aidl_lang.compile(PLATE, {"width": 80, "style": "square"})
    assert (tmp_path / "80.svg").read_bytes() == direct.export(".svg", theme="ink")


@pytest.mark.usefixtures("at_once")
def test_neighbours_of_different_kind_are_told() -> None:
    """A slot leaves its plate between 60 and 80; that more bores are asked for is no change of kind."""
    text = """
    solid plate {
        param width = 80 in 40..120
        param bores = 2 in 1..4
        body = rectangle(center: fixed((0, 0)), width: width, height: 40)
        for i in 1..bores { hole bore[i] { rim = circle(center: fixed((9 * i - 18, 0)), radius: 2) } }
        hole slot { rim = rectangle(center: fixed((30, 0)), width: 10, height: 10) }
    }
    """
    assert aidl_lang.sweep(text, {"width": [120, 80, 60], "bores": [1, 2]}, jobs=1).turns == [
        "`width` from 60 to 80 with bores=1: holes go from 1 to 2",
        "`width` from 60 to 80 with bores=2: holes go from 2 to 3",
    ]
    (told,) = aidl_lang.sweep(text, {"width": [40, 60]}, jobs=1).turns
    assert told.startswith("`width` from 40 to 60: ")
    assert "no more: W0703" in told


def test_values_may_be_written_as_on_the_command_line() -> None:
    assert len(aidl_lang.sweep(PLATE, {"width": "40..80/5", "bored": "*"})) == 10
    assert len(aidl_lang.sweep(PLATE, {}, random=7, seed=3)) == 7


@pytest.mark.parametrize(
    ("name", "more", "said"),
    [
        ("widht", {}, "there is no param `widht`"),
        ("width", {"on": "tpc://x"}, "there is no engine `tpc://x`"),
        ("width", {"kerv": 1}, "there is no option `kerv`"),
    ],
)
def test_what_cannot_be_is_refused(name: str, more: dict[str, object], said: str) -> None:
    with pytest.raises(AidlError) as raised:
        list(aidl_lang.sweep(PLATE, {name: [1]}, **more))
    assert raised.value.diagnostic.message == said


def test_a_program_that_is_wrong_is_refused() -> None:
    with pytest.raises(AidlError, match="there is no"):
        aidl_lang.sweep("solid s { param w = 3\n body = rectangle(width: wdth, height: 3) }", {"w": [1]})
