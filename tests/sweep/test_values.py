"""What is varied: values as they are written, their products, tables, and what is drawn at random."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import Reads
from aidl_lang.tools.sweeping import plan as plan_module
from aidl_lang.tools.sweeping.plan import axis, from_values, planned, read_table

PROGRAM = """\
param width = 60mm in 40..200
param n = 3 in 1..9 step 2
param style = "round" in ["round", "square"]
param name = "Ada"
param hollow = false
param turn = 30deg
solid s {
    param deep = 4 in 1..8
    body = rectangle(width: width, height: deep)
}
"""


@pytest.fixture(scope="module")
def knobs() -> tuple[Knob, ...]:
    found, diagnostics = pipeline.knobs(SourceFile("s.aidl", PROGRAM))
    assert not any(d.is_error for d in diagnostics)
    return found


@pytest.mark.parametrize(
    ("name", "written", "values"),
    [
        ("width", "60..200/8", [60, 80, 100, 120, 140, 160, 180, 200]),
        ("width", "60..200 step 50", [60, 110, 160]),
        ("width", "6cm..20cm/2", [60, 200]),
        ("width", "0.1..0.3 step 0.1", [0.1, 0.2, 0.3]),
        ("width", "60", [60]),
        ("width", "60,7cm , 80", [60, "7cm", 80]),
        ("n", "1..9", [1, 3, 5, 7, 9]),
        ("n", "*", [1, 3, 5, 7, 9]),
        ("style", "round,square", ["round", "square"]),
        ("style", "*", ["round", "square"]),
        ("name", 'Ada,"Bob, jr"', ["Ada", "Bob, jr"]),
        ("name", "1..3", ["1..3"]),
        ("hollow", "*", [False, True]),
        ("hollow", "true,0", [True, False]),
        ("turn", "0..1turn/3", [0, 180, 360]),
        ("Deep", "1,2", [1, 2]),
    ],
)
def test_values_as_they_are_written(
    knobs: tuple[Knob, ...], name: str, written: str, values: list[object]
) -> None:
    assert list(axis(name, written, knobs).values) == values


def test_the_last_param_changes_quickest(knobs: tuple[Knob, ...]) -> None:
    plan = planned(knobs, [axis("width", "60,80", knobs), axis("style", "*", knobs)])
    assert len(plan) == 4
    assert [(v.number, *v.values.values()) for v in plan] == [
        (1, 60, "round"),
        (2, 60, "square"),
        (3, 80, "round"),
        (4, 80, "square"),
    ]


def test_what_is_drawn_depends_on_the_seed_alone(knobs: tuple[Knob, ...]) -> None:
    few = list(planned(knobs, [], drawn=(5, 1)))
    more = list(planned(knobs, [axis("width", "50..60", knobs, is_drawn=True)], drawn=(50, 1)))
    other = list(planned(knobs, [], drawn=(5, 2)))
    assert [v.values["style"] for v in few] == [v.values["style"] for v in more[:5]]
    assert few != other
    assert {v.values["n"] for v in more} == {1, 3, 5, 7, 9}
    assert all(50 <= v.values["width"] <= 60 for v in more)
    assert len({v.values["width"] for v in more}) == 50
    assert {"style", "hollow"} < set(few[0].values)
    assert not {"name", "turn"} & set(few[0].values)


def table(folder: Path, text: bytes) -> Path:
    path = folder / "orders.csv"
    path.write_bytes(text)
    return path


def test_a_table_has_params_and_other_columns(tmp_path: Path, knobs: tuple[Knob, ...]) -> None:
    text = '\ufeffOrder no.,Name,width,hollow\r\n17,"two\r\nlines",6cm,TRUE\r\n\r\n18," x ",,0\r\n'
    rows = read_table(table(tmp_path, text.encode()), knobs, Reads())
    assert (rows.params, rows.labels) == (("name", "width", "hollow"), ("Order no.",))
    assert rows.rows == (
        ({"name": "two\r\nlines", "width": "6cm", "hollow": True}, {"Order no.": "17"}),
        ({"name": " x ", "hollow": False}, {"Order no.": "18"}),
    )


def test_tables_that_are_none_are_refused(tmp_path: Path, knobs: tuple[Knob, ...]) -> None:
    """Beside those of `tests/cli/refused.md`."""
    long = b"name\n" + b"x" * 1_000_001 + b"\n"
    for text, said in (
        (b"width\n\xff\n", r"is not UTF-8 text \(byte 6\)"),
        (long, "larger than field limit"),
    ):
        with pytest.raises(AidlError, match=said):
            read_table(table(tmp_path, text), knobs, Reads())


def test_values_from_python(knobs: tuple[Knob, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_module, "MOST", 1000)
    import numpy as np

    assert from_values("width", range(60, 81, 10), knobs).values == (60.0, 70.0, 80.0)
    assert from_values("width", np.linspace(0, 1, 3), knobs).values == (0.0, 0.5, 1.0)
    assert from_values("name", "abc", knobs).values == ("abc",)
    assert from_values("hollow", [True, "false"], knobs).values == (True, False)
    for wrong, said in (
        ([], "there are no values"),
        ([None], "takes numbers"),
        (iter(int, 1), "more than 1000 "),
    ):
        with pytest.raises(AidlError, match=said):
            from_values("width", wrong, knobs)
