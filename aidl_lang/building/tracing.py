"""Drawings of other programs in a program: one geometry each, of which the parts are views."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from aidl_lang.building.model import Geometry
from aidl_lang.building.state import Env, Interpreter
from aidl_lang.building.values import TextVal, Value
from aidl_lang.common.drawings.drawing import Trace
from aidl_lang.syntax import ast


def trace_of(it: Interpreter, name: str) -> Trace:
    """Returns the outlines under a name, of the drawing in whose definitions the call under way stands."""
    return it.program.resolution.drawings[it.call_sites[-1].span.source].outlines.trace(name)


def part(it: Interpreter, a: Mapping[str, Value], node: ast.Call, env: Env) -> Value:
    """Returns some outlines of a drawing, to be measured and copied: they are drawn with the others."""
    whole, name = a["of"], a["part"]
    assert isinstance(whole, Geometry)
    assert isinstance(name, TextVal)
    outlines = trace_of(it, name.value)
    return replace(whole, trace=outlines, name=name.value, container=whole, views={}, attributes={})
