"""What is varied: values as they are written, their products, tables, and what is drawn at random."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import Reads
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


@pytest.mark.parametrize(
    ("name", "written", "said"),
    [
        ("widht", "1", "there is no param `widht`"),
        ("width", "60..200", "`60..200` does not say how many values `width` takes"),
        ("width", "200..60/8", "the range `200..60/8` of `width` runs backwards"),
        ("width", "60..200/0", "`60..200/0` asks for 0 values; a sweep has 1 to 1000000"),
        ("width", "60..", "`60..` is no range for `width`"),
        ("width", "60..200/8/2", "`60..200/8/2` is no range for `width`"),
        ("width", "60..200 step 0", "the step of `width` is not above 0"),
        (
            "width",
            "0..1e9 step 1e-9",
            "`width` would take 999999999999999873 values; a sweep has 1 to 1000000",
        ),
        ("width", "1e999..2e999/2", "`1e999` is too large for `width`"),
        ("width", "60xy..80/2", "`60xy` of `width` has no unit that there is"),
        ("width", "60,,80", "`60,,80` leaves a value of `width` out"),
        ("width", "*", "`width` has no choices and no range with a step, so `*` says nothing"),
        ("name", 'a,"b', '`a,"b` is no list of values for `name`: a quote has no end'),
    ],
)
def test_values_that_say_nothing_are_refused(
    knobs: tuple[Knob, ...], name: str, written: str, said: str
) -> None:
    with pytest.raises(AidlError) as raised:
        axis(name, written, knobs)
    message = raised.value.diagnostic.message
    assert message == said or ("would take" in said and "would take" in message)


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


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ([("width", "60"), ("Width", "80")], "`width` is set twice"),
        ([], "nothing is varied"),
        (
            [("width", "1..2/1000"), ("deep", "1..2/2000")],
            "2000000 variants are too many; a sweep has up to 1000000",
        ),
    ],
)
def test_plans_that_cannot_be_are_refused(
    knobs: tuple[Knob, ...], values: list[tuple[str, str]], said: str
) -> None:
    with pytest.raises(AidlError) as raised:
        planned(knobs, [axis(*each, knobs) for each in values])
    assert raised.value.diagnostic.message == said


def table(folder: Path, text: str | bytes) -> Path:
    path = folder / "orders.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_a_table_has_params_and_other_columns(tmp_path: Path, knobs: tuple[Knob, ...]) -> None:
    text = '\ufeffOrder no.,Name,width,hollow\r\n17,"two\r\nlines",6cm,TRUE\r\n\r\n18," x ",,0\r\n'
    rows = read_table(table(tmp_path, text), knobs, Reads())
    assert (rows.params, rows.labels) == (("name", "width", "hollow"), ("Order no.",))
    assert rows.rows == (
        ({"name": "two\r\nlines", "width": "6cm", "hollow": True}, {"Order no.": "17"}),
        ({"name": " x ", "hollow": False}, {"Order no.": "18"}),
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "`{}` is empty"),
        ("width\n", "`{}` has no rows below its first line"),
        ("widht,name\n1,a\n", "`{}` has a column `widht`, and there is no such param"),
        ("width;name\n1,5;a\n", "the cells of `{}` are separated by semicolons, not by commas"),
        ("width\tname\n1\ta\n", "the cells of `{}` are separated by tabs, not by commas"),
        ("order,city\n1,a\n", "no column of `{}` is a param: it has `order` and `city`"),
        ("width,name\n1\n", "line 2 of `{}` has 1 cells, its first line 2"),
        ("width,WIDTH\n1,2\n", "`{}` has two columns `WIDTH`"),
        ("width,\n1,2\n", "a column of `{}` has no name"),
        ('width\n"1\n', "line 2 of `{}` is no CSV: unexpected end of data"),
        (b"width\n\xff\n", "`{}` is not UTF-8 text (byte 6)"),
        (
            "name\n" + "x" * 1_000_001 + "\n",
            "line 2 of `{}` is no CSV: field larger than field limit (1000000)",
        ),
    ],
)
def test_tables_that_are_none_are_refused(
    tmp_path: Path, knobs: tuple[Knob, ...], text: str | bytes, said: str
) -> None:
    path = table(tmp_path, text)
    with pytest.raises(AidlError) as raised:
        read_table(path, knobs, Reads())
    assert raised.value.diagnostic.message == said.replace("{}", str(path))


def test_values_from_python(knobs: tuple[Knob, ...]) -> None:
    import numpy as np

    assert from_values("width", range(60, 81, 10), knobs).values == (60.0, 70.0, 80.0)
    assert from_values("width", np.linspace(0, 1, 3), knobs).values == (0.0, 0.5, 1.0)
    assert from_values("name", "abc", knobs).values == ("abc",)
    assert from_values("hollow", [True, "false"], knobs).values == (True, False)
    for wrong, said in (
        ([], "there are no values"),
        ([None], "takes numbers"),
        (iter(int, 1), "more than 1000000"),
    ):
        with pytest.raises(AidlError, match=said):
            from_values("width", wrong, knobs)
