"""Knobs: a `param` with its range, its value from the program or from outside."""

from __future__ import annotations

import math
import re

from aidl_lang.building import expression as ex
from aidl_lang.building.coerce import constant
from aidl_lang.building.model import Knob, Structure
from aidl_lang.building.state import Env, Interpreter, ParamBinding, Reach
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    Nothing,
    Num,
    RangeVal,
    TextVal,
    Value,
    kind_of,
    members,
    number,
    type_of,
)
from aidl_lang.checking import rules, units
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, literal, ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z]*)\s*")
_RANGE_SLACK = 1e-9
_UNITS: dict[units.MaybeDimension, str] = {units.ANGLE: "deg", units.LENGTH: "mm"}


def knob_path(structure: Structure, name: str) -> str:
    """Returns the path by which a param is set from outside: from the root, without the root's own name."""
    below = structure.path.partition(".")[2] if structure.parent is not None else ""
    return f"{below}.{name}" if below else name


def read_param(it: Interpreter, binding: ParamBinding, node: ast.Node) -> Value:
    """Returns the value of a knob: evaluated, checked against its range and registered on first use."""
    if binding.known is None:
        if binding.running:
            it.report("E0207", f"param `{binding.node.name.text}` is defined by way of itself", node)
            return NOTHING
        binding.running = True
        binding.known = _evaluate(it, binding)
        binding.running = False
    return binding.known


def _evaluate(it: Interpreter, binding: ParamBinding) -> Value:
    node = binding.node
    env = Env(binding.scope, binding.structure, Reach.OWN)
    written = it.evaluate(node.value, env)
    if isinstance(written, Num):
        known = constant(it, written, node.value, "the value of a `param`")
        written = number(known, written.dimension) if known is not None else NOTHING
    elif not isinstance(written, TextVal | bool | Nothing):
        it.report("E0314", f"a `param` is a number, a text or true/false, not {kind_of(written)}", node.value)
        return NOTHING
    domain = it.evaluate(node.domain, env) if node.domain is not None else None
    step = it.evaluate(node.step, env) if node.step is not None else None
    if isinstance(written, Nothing) or isinstance(domain, Nothing):
        return NOTHING
    low, high, choices = _domain(it, domain, node)
    path = knob_path(binding.structure, node.name.text)
    value = _from_outside(it, path, written, choices)
    counts = node in it.program.counts and _is_whole(written)
    if counts and not _is_whole(value):
        message = f"`{path}` is {literal(_plain(value))} as set from outside, and it counts something"
        it.report("E0909", message, node.name, label="a whole number", hints=["give a whole number"])
        value = written
    if counts and low is not None and high is not None:
        low, high = math.ceil(low), math.floor(high)
    where = "written" if value is written else "set from outside"
    if not _is_allowed(value, low, high, choices):
        words = " or ".join(map(literal, choices))
        allowed = words if low is None or high is None else f"{low:g}..{high:g}"
        code = "E0505" if value is written else "E0909"
        message = f"`{path}` is {literal(_plain(value))} as {where}, outside its range {allowed}"
        place, fix = (node.value, _unit_of_range(node)) if value is written else (node.name, None)
        hint = f"give a value in {allowed}, or widen the range of the `param`"
        it.report(code, message, place, label=f"allowed: {allowed}", hints=[hint], fix=fix)
    unit = _UNITS.get(value.dimension, "") if isinstance(value, Num) else ""
    pace = step.value if isinstance(step, Num) else 1.0 if counts and not choices else None
    it.knobs.append(Knob(path, _plain(value), low, high, choices, pace, unit, node.doc, node.span))
    if isinstance(value, Num):
        return Num(value.expression, value.dimension, Exactness.PARAM)
    return TextVal(value.value, is_param=True) if isinstance(value, TextVal) else value


def _is_whole(value: Value) -> bool:
    return isinstance(value, Num) and value.dimension is None and value.value.is_integer()


def _unit_of_range(node: ast.Param) -> Fix | None:
    """Returns the fix that writes `8m in 6..14` as `8m in 6m..14m`; None if the range would not hold."""
    match node.value, node.domain:
        case ast.Number(unit=str() as unit), ast.Range(
            ast.Number(unit=None) as low, ast.Number(unit=None) as high
        ):
            if low.value <= node.value.value <= high.value:
                ends = [Span(end.span.source, end.span.end, end.span.end) for end in (low, high)]
                return Fix(f"write the range in {unit} too", tuple(Edit(end, unit) for end in ends))
    return None


def _plain(value: Value) -> float | str | bool:
    match value:
        case Num() | TextVal():
            return value.value
        case bool():
            return value
        case _:
            raise TypeError(f"no plain form of {value!r}")


def _domain(
    it: Interpreter, domain: Value | None, node: ast.Param
) -> tuple[float | None, float | None, tuple[float | str | bool, ...]]:
    if domain is None:
        return None, None, ()
    if isinstance(domain, RangeVal):
        return domain.start.value, domain.end.value, ()
    items = members(domain)
    if items is None or not all(isinstance(i, Num | TextVal | bool) for i in items):
        if node.domain is not None:
            it.misfit(rules.no_domain(type_of(domain)), node.domain)
        return None, None, ()
    return None, None, tuple(_plain(i) for i in items)


def _is_allowed(
    value: Value, low: float | None, high: float | None, choices: tuple[float | str | bool, ...]
) -> bool:
    if choices:
        return _plain(value) in choices
    if low is None or high is None:
        return True
    slack = _RANGE_SLACK * max(1.0, abs(low), abs(high))
    return isinstance(value, Num) and low - slack <= value.value <= high + slack


def _from_outside(
    it: Interpreter, path: str, written: Value, choices: tuple[float | str | bool, ...]
) -> Value:
    """Returns the value set for a path with `-D path=value` or `compile(params=…)`, else the written one."""
    names = {fold(path), fold(f"{it.root.name if it.root else ''}.{path}")}
    key = next((key for key in it.overrides if fold(key.strip()) in names), None)
    if key is None:
        return written
    it.used_overrides.add(key)
    given = it.overrides[key]
    value = _parse(given, written)
    if value is None:
        other = "true or false" if isinstance(written, bool) else "a number"
        kind = "a text" if isinstance(written, TextVal) else other
        it.report("E0910", f"`{key}={given}` does not fit: `{path}` is {kind}", None)
        return written
    return value


def _parse(given: str | float | bool, written: Value) -> Value | None:
    match written:
        case TextVal():
            return TextVal(_unquoted(given.strip())) if isinstance(given, str) else None
        case bool():
            word = str(given).strip().casefold()
            return {"true": True, "false": False, "1": True, "0": False}.get(word)
        case Num(dimension=dimension):
            if isinstance(given, bool):
                return None
            if isinstance(given, int | float):
                return number(float(given), dimension) if ex.is_number(given) else None
            matched = _NUMBER.fullmatch(given)
            if matched is None:
                return None
            factor, unit = UNITS.get(matched[2], (1.0, None))
            if matched[2] and (unit is None or dimension not in (None, unit)):
                return None
            value = float(matched[1]) * factor
            return number(value, dimension) if ex.is_number(value) else None
        case _:
            return None


def _unquoted(text: str) -> str:
    """Returns a text without the quotes around it; one that it has on one side alone is a part of it."""
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    return text[1:-1] if is_quoted else text


def report_unused(it: Interpreter) -> None:
    """Reports values set from outside that no param takes."""
    paths = [knob.path for knob in it.knobs]
    for key in it.overrides:
        if key not in it.used_overrides:
            like = nearest(key, paths)
            hints = did_you_mean(like[:1])
            known = first_few(ticked(paths), 12, "") or "none"
            hints.append(f"params of this program: {known}")
            it.report("E0911", f"there is no param `{key}`", None, hints=hints)
