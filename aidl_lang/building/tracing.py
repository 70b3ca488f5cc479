"""Drawings of other programs in a program: one geometry each, of which the parts are views."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from aidl_lang.building.model import Geometry
from aidl_lang.building.state import Env, Interpreter, Stop
from aidl_lang.building.values import TextVal, Value
from aidl_lang.common.drawings.drawing import Trace
from aidl_lang.syntax import ast


def trace_of(it: Interpreter, name: str) -> Trace:
    """Returns the outlines under a name, of the drawing whose definitions call; ends building elsewhere."""
    call = it.call_sites[-1]
    if (drawing := it.program.resolution.drawings.get(call.span.source)) is None:
        it.refuse(call, 'imports write it: `import "logo.svg" as logo` has the parts of a drawing')
        raise Stop
    return drawing.outlines.trace(name)


def part(it: Interpreter, a: Mapping[str, Value], node: ast.Call, env: Env) -> Value:
    """Returns some outlines of a drawing, to be measured and copied: they are drawn with the others."""
    whole, name = a["of"], a["part"]
    assert isinstance(whole, Geometry)
    assert isinstance(name, TextVal)
    outlines = trace_of(it, name.value)
    return replace(whole, trace=outlines, name=name.value, container=whole, views={}, attributes={})
