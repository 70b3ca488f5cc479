"""What must hold of every program, whatever stands in it: it is answered in bounded time, without an
exception, by diagnostics that can be shown or by files with numbers in them; fixes end; and formatting
changes nothing.
"""

from __future__ import annotations

import json
import random
import re
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

from aidl_lang import pipeline
from aidl_lang.building.state import BuildingLimits
from aidl_lang.common.diagnostics import Diagnostic, has_errors
from aidl_lang.common.render.terminal import render
from aidl_lang.common.source import SourceFile
from aidl_lang.export.job import ExportError, Options
from aidl_lang.parser import parse
from aidl_lang.pipeline import Settings
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_module
from aidl_lang.tools.mending import mend
from tests.interrupts import TooLong, within

SETTINGS = replace(
    Settings(),
    building=BuildingLimits(entities=8000, turns=50_000, seconds=1.5),
    solving=replace(Settings().solving, seconds=3.0),
    drawing=2.0,
)
"""Tighter than what a user has, so that a program that asks for much is soon through."""
LONGEST = {"check": 12.0, "fix": 60.0, "format": 40.0, "compile": 30.0, "write": 12.0}
"""Seconds of the processor's time, well above what the limits of `SETTINGS` add up to; to see that formatting
changes nothing takes four checks."""
RECURSION = 20_000
"""Python frames, as the compiler has them: the judge itself walks through trees that are as deep."""
LAYERS = frozenset({"names", "points", "bbox", "constraints", "dof", "plan"})

_NO_NUMBER = re.compile(r"(?<![\w.#-])-?(?:nan|inf|infinity)(?![\w-])", re.IGNORECASE)
_TEXT = re.compile(
    r"<text.*?</text>|<title>.*?</title>|<desc>.*?</desc>|=\"[^\"]*[A-Za-z]{4,}[^\"]*\"", re.DOTALL
)


@dataclass(frozen=True)
class Finding:
    """Something that does not hold: `kind` is alike for findings with one cause, as far as one can tell."""

    stage: str
    kind: str
    details: str


def finding(text: str, seed: int = 0) -> Finding | None:
    """What is wrong with the answers to a program; None if nothing is."""
    sys.setrecursionlimit(max(sys.getrecursionlimit(), RECURSION))
    source = SourceFile("fuzz.aidl", text)
    steps = {"check": _check, "fix": _fix, "format": _format, "compile": lambda it: _compile(it, seed)}
    for stage, step in steps.items():
        found = attempt(stage, lambda step=step: step(source))  # type: ignore[misc]
        if found is not None:
            return found
    return None


def _check(source: SourceFile) -> Finding | None:
    return _shown("check", pipeline.check(source, settings=SETTINGS))


def _fix(source: SourceFile) -> Finding | None:
    mended = mend(source, settings=SETTINGS)
    again = mend(mended.source, settings=SETTINGS)
    if again.fixes:
        return Finding("fix", f"goes on: {again.fixes[0]}", mended.source.text)
    return None


def _format(source: SourceFile) -> Finding | None:
    text, _ = pipeline.formatted(source)
    if text is None:
        return None
    plain = format_module(parse(source))  # names as they were written
    trees = [_as_meant(parse(SourceFile(source.name, t)).module) for t in (source.text, plain)]
    if not ast.same(*trees):
        return Finding("format", "another program", plain)
    twice, _ = pipeline.formatted(SourceFile(source.name, text))
    if text != twice:
        return Finding("format", "another form the second time", f"{text}\n=== again\n{twice}")
    before, after = (_errors(SourceFile(source.name, t)) for t in (source.text, text))
    if before is None or after is None or before == after:
        return None
    return Finding("format", f"{before} became {after}", text)


def _compile(source: SourceFile, seed: int) -> Finding | None:
    compiled = pipeline.compile(source, settings=SETTINGS)
    if (found := _shown("compile", compiled.diagnostics)) is not None:
        return found
    if compiled.status == "wrong" and not has_errors(compiled.diagnostics):
        return Finding("compile", "wrong, and no error says why", "")
    if compiled.model is None:
        return None
    suffixes = [".svg", ".json", *random.Random(seed).sample((".dxf", ".pdf", ".png", ".stl"), 1)]
    for suffix in suffixes:
        for options in (Options(), Options(show=LAYERS, dimension=True)):
            if options.dimension and suffix not in (".svg", ".pdf", ".png"):
                continue
            found = attempt(
                f"write {suffix}",
                lambda suffix=suffix, options=options: _written(compiled, suffix, options),  # type: ignore[misc]
            )
            if found is not None:
                return found
    return None


def _as_meant(node: ast.Node) -> ast.Node:
    """A tree in which what means the same is written in one way: `=` among constraints, `constrain` before
    one that needs it or not, `cut` for `hole`.
    """
    changed: dict[str, object] = {}
    for part in fields(node):
        value = getattr(node, part.name)
        if isinstance(value, ast.Node):
            changed[part.name] = _as_meant(value)
        elif isinstance(value, tuple):
            changed[part.name] = tuple(_as_meant(v) if isinstance(v, ast.Node) else v for v in value)
    node = replace(node, **changed)
    if isinstance(node, ast.Structure):
        return replace(node, kind_word=replace(node.kind_word, text=node.kind))
    if isinstance(node, ast.Equation):
        return ast.ExpressionStatement(node.meant, span=node.span)
    if isinstance(node, ast.Constrain) and not node.braces and len(node.items.statements) == 1:
        return node.items.statements[0]
    return node


def attempt(stage: str, step: Callable[[], Finding | None]) -> Finding | None:
    """What a step finds, what it raises, or that it takes too long."""
    try:
        with within(LONGEST[stage.split()[0]]):
            return step()
    except TooLong:
        return Finding(stage, "takes too long", traceback.format_exc(limit=-12))
    except Exception as error:  # noqa: BLE001 (that it raises anything at all is what is looked for)
        return Finding(stage, _cause(error), traceback.format_exc(limit=-20))


def _cause(error: BaseException) -> str:
    """The kind of an exception and the line of the project it comes from."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if "aidl_lang" in f.filename]
    at = f" in {frames[-1].filename.rpartition('aidl_lang/')[2]}:{frames[-1].name}" if frames else ""
    return f"{type(error).__name__}{at}"


def _errors(source: SourceFile) -> list[str] | None:
    """The codes of the errors that checking finds, in order of the alphabet; None where time ran out, which
    the same program may do at one time and not at another.
    """
    found = [d for d in pipeline.check(source, settings=SETTINGS) if d.is_error]
    if any(d.message.endswith("seconds") for d in found):
        return None
    return sorted(d.code for d in found)


def _shown(stage: str, diagnostics: list[Diagnostic]) -> Finding | None:
    for diagnostic in diagnostics:
        text = render(diagnostic)
        if not text.strip():
            return Finding(stage, "an empty message", repr(diagnostic))
    return None


def _written(compiled: pipeline.Compiled, suffix: str, options: Options) -> Finding | None:
    try:
        data = compiled.export(suffix, options)
    except ExportError:
        return None
    if suffix == ".json":
        json.loads(data, parse_constant=_refuse)
    elif suffix in (".svg", ".dxf"):
        text = _TEXT.sub("", data.decode("utf-8"))
        if (found := _NO_NUMBER.search(text)) is not None:
            return Finding(
                f"write {suffix}", "a number that is none", text[max(0, found.start() - 80) :][:160]
            )
    return None


def _refuse(word: str) -> Any:
    raise ValueError(f"{word} is no JSON")
