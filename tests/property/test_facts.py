"""What is worked out when it is read is the same whoever reads it, in whichever order, and if nobody does."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.running import Cancelled, OutOfTime, cancelled_when, limited_to
from aidl_lang.common.source import SourceFile
from aidl_lang.compiled import Compiled
from aidl_lang.export.job import SHOW, Options
from tests.amount import tries
from tests.property.programs import Sketch, sketches

EVERY = Options(frozenset(SHOW), dimension=True)
TOLD = (
    "",
    'assert part_0.width < 3, "small"',
    '@allow("W0705") let odd = 3',
    "constrain { part_0.left == 0, part_0.left == 0 }",
    "constrain { part_0.width == 400 }",
    "constrain { part_0.right >= part_1.right + 7, part_0.left == part_1.left - 5 }",
    "let unused = 3",
)
"""Statements of which there is something to tell."""


def _written(suffix: str, options: Options | None = None) -> Callable[[Compiled], object]:
    def written(found: Compiled) -> object:
        try:
            return found.export(suffix, options)
        except AidlError as error:
            return str(error)

    return written


FACTS: Mapping[str, Callable[[Compiled], object]] = {
    "ok": lambda found: (found.status, found.ok, found.errors),
    "diagnostics": lambda found: found.diagnostics,
    "standing": lambda found: found.find().standing,
    "mobility": lambda found: found.model and found.model.mobility(),
    "motions": lambda found: found.model and found.model.motions,
    "sizes": lambda found: found.model and found.model.sizes,
    "mentions": lambda found: found.model and [c.mentions() for c in found.model.constraints],
    "near": lambda found: found.drawing and found.drawing.contacts.near(),
    "pairs": lambda found: found.drawing and found.drawing.pairs,
    "conflicts": lambda found: found.conflicts(),
    "again": lambda found: pickle.loads(pickle.dumps(found)).diagnostics,
    "svg": _written(".svg"),
    "marked": _written(".svg", EVERY),
    "dxf": _written(".dxf"),
    "stl": _written(".stl"),
    "json": _written(".json"),
}

ORDERS = st.lists(st.sampled_from(sorted(FACTS)), unique=True, max_size=6)


def compiled(text: str, *, strict: bool = False) -> Compiled:
    return pipeline.compile(SourceFile("t.aidl", text), settings=pipeline.Settings(strict=strict))


def assert_same(text: str, orders: Sequence[Sequence[str]], *, strict: bool = False) -> None:
    """Asserts that each fact is what it is when it is read alone, and that what is an error is known before
    anything is read.
    """
    alone: dict[str, str] = {}
    for order in orders:
        found = compiled(text, strict=strict)
        for name in order:
            if name not in alone:
                alone[name] = repr(FACTS[name](compiled(text, strict=strict)))
            assert repr(FACTS[name](found)) == alone[name], name
        assert found.errors == [d for d in found.diagnostics if d.is_error]


@given(sketches(), st.sampled_from(TOLD), st.booleans(), ORDERS)
@tries(20)
def test_the_order_of_reading_does_not_matter(
    sketch: Sketch, told: str, strict: bool, order: list[str]
) -> None:
    text = sketch.text(relations=sketch.relations).removesuffix("}\n") + f"{told}\n}}\n"
    assert_same(text, [order, order[::-1]], strict=strict)


TOUCHING = """\
assembly model {
    solid a { body = rectangle(center: fixed((0, 0)), width: 4, height: 4) }
    solid b { body = rectangle(center: fixed((9, 0)), width: 4, height: 4) }
}
"""


def test_reading_that_is_given_up_can_be_done_again() -> None:
    found = compiled(TOUCHING)
    with cancelled_when(lambda: True), pytest.raises(Cancelled):
        _ = found.diagnostics
    with limited_to(0.0), pytest.raises(OutOfTime):
        _ = found.diagnostics
    assert [d.code for d in found.diagnostics] == ["W0705", "W0705"]


def test_nothing_is_worked_out_unread(monkeypatch: pytest.MonkeyPatch) -> None:
    def unread(*given: object) -> None:
        raise AssertionError("it was worked out")

    monkeypatch.setattr("aidl_lang.solver.analysis.analyse", unread)
    monkeypatch.setattr("aidl_lang.explaining.outcome.solution_notes", unread)
    monkeypatch.setattr("aidl_lang.geometry.drawing.detached_notes", unread)
    monkeypatch.setattr("aidl_lang.geometry.boolean._compare", unread)
    found = compiled(TOUCHING)
    assert found.ok
    assert found.export(".svg")
    assert found.export(".dxf")
    with pytest.raises(AssertionError, match="worked out"):
        _ = found.diagnostics
