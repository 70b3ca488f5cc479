"""What is true of a scene holds, and what is not is refused: `statements.txt`, worked out by hand."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile

# low: 0…20 × 0…10; high: 5…15 × 12…18, a hole below; ball about (30, 5), radius 5, in a frame that is turned.
SCENE = """
assembly scene {
    param gap_wanted = 2
    flat  = line(fixed((0, 0)), fixed((10, 0)))
    up    = line(fixed((10, 0)), fixed((10, 5)))
    slant = line(fixed((0, 20)), fixed((10, 30)))
    dot   = fixed((5, 0))
    round = circle(center: fixed((5, 4)), radius: fixed(4))
    bend  = arc(center: fixed((9, 5)), radius: fixed(1), start_angle: fixed(0deg), end_angle: fixed(90deg))
    solid low at fixed((0, 0)) { r = line(fixed((0, 0)), fixed((20, 10))) }
    solid high at fixed((0, 0)) {
        r = line(fixed((5, 12)), fixed((15, 18)))
        hole cut at fixed((0, 0)) { c = circle(center: fixed((10, 0)), radius: fixed(3)) }
    }
    solid ball at fixed((0, 0)) rotated 30deg {
        c = circle(center: fixed(turned((30, 5), -30deg)), radius: fixed(5))
    }
    solid plan at fixed((0, 0)) { r = line(fixed((40, 0)), fixed((50, 10))) }
    constrain {
"""
FIRST = SCENE.count("\n") + 1
SETTINGS = pipeline.Settings()
SETTINGS = replace(SETTINGS, solving=replace(SETTINGS.solving, explain=False))


def statements(truth: str) -> list[str]:
    text = Path(__file__).with_name("statements.txt").read_text("utf-8")
    said = text.partition(f"=== {truth}\n")[2].partition("===")[0]
    return [s.strip() for s in re.split("[;\n]", said) if s.strip()]


def refused(said: list[str]) -> list[str]:
    """Those of some statements, each on a line of its own, of which an error tells."""
    source = SourceFile("scene.aidl", SCENE + "\n".join(said) + "\n}}\n")
    errors = [d for d in pipeline.compile(source, settings=SETTINGS).diagnostics if d.is_error]
    assert {d.code for d in errors} <= {"E0513"}, [d.message for d in errors]
    lines = {d.span.line for d in errors if d.span is not None}
    return [statement for line, statement in enumerate(said, FIRST) if line in lines]


def test_what_is_true_holds() -> None:
    assert refused(statements("true")) == []


@pytest.mark.parametrize("start", range(0, 150, 50))
def test_what_is_false_is_refused(start: int) -> None:
    """Some at a time: there are never more than a hundred errors."""
    said = statements("false")[start : start + 50]
    assert refused(said) == said
