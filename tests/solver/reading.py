"""Problems of the corpus, as JSON: groups by their parents, unknowns, `let`, constraints, what is observed
and what is expected. Expressions are those of Python, with `^` for powers; `{"x": 1}` is short for
`{"x": {"guess": 1}}`, and a text for `{"is": text}`.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from aidl_lang.solver import Problem, Relation, Row
from tests.solver.build import E, Model, call

_TOKEN = re.compile(r"[^\W\d]\w*(?:\.\w+|\[\d+\])*|[\d.]+(?:e-?\d+)?")
_FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan2", "sqrt", "square", "hypot", "abs", "select")


@dataclass(frozen=True)
class Case:
    """A problem with what its file says; the tag of a constraint without one is `#` and its index."""

    problem: Problem
    about: str
    tags: tuple[str, ...]
    expected: dict[str, Any]


def read(path: Path) -> Case:
    return _Reading(json.loads(path.read_text("utf-8"))).case()


class _Reading:
    def __init__(self, form: dict[str, Any]) -> None:
        self.form = form
        self.model = Model()
        self.groups = {"root": 0}
        self.names: dict[str, E | float] = {"pi": self._lift(math.pi)}
        self.longest: list[float] = []
        self.functions: dict[str, Callable[..., E]] = {name: self._function(name) for name in _FUNCTIONS}
        for name in ("min", "max"):
            self.functions[name] = self._extreme(f"{name}imum")

    def case(self) -> Case:
        form = self.form
        for name, parent in form.get("groups", {}).items():
            self.groups[name] = self.model.group(self.groups[parent])
        for name, entry in form.get("unknowns", {}).items():
            self._unknown(name, entry if isinstance(entry, dict) else {"guess": entry})
        names = tuple(self.names)[1:]
        self._lets(form)
        tags = [self._constraint(i, _member(each)) for i, each in enumerate(form.get("constraints", []))]
        for each in map(_member, form.get("observed", [])):
            self.model.observe(self.groups[each.get("group", "root")], self._lift(self._value(each["is"])))
        problem = replace(self.model.problem(), names=names, longest=np.array(self.longest))
        return Case(problem, form["about"], tuple(tags), form["expected"])

    def _unknown(self, name: str, entry: dict[str, Any]) -> None:
        """What no frame owns is observed, unless the file says what is."""
        group, frame = self.groups[entry.get("group", "root")], self.groups.get(entry.get("frame", ""), -1)
        owner = group if frame < 0 else self.model.parent[frame]
        is_seen = frame < 0 and "observed" not in self.form
        more = {n: entry[n] for n in ("kept", "scale") if n in entry}
        self.names[name] = self.model.unknown(entry["guess"], owner, frame=frame, visible=is_seen, **more)
        self.longest.append(entry.get("longest", math.inf))

    def _lets(self, entry: dict[str, Any]) -> None:
        for name, text in entry.get("let", {}).items():
            self.names[name] = self._value(text)

    def _constraint(self, index: int, entry: dict[str, Any]) -> str:
        self._lets(entry)
        texts = entry["is"] if isinstance(entry["is"], list) else [entry["is"]]
        scales = entry.get("scale", 1.0)
        scales = scales if isinstance(scales, list) else [scales] * len(texts)
        model, rows = self.model, tuple(map(self._row, texts, scales))
        placed = frozenset(model.index(self.names[name]) for name in entry.get("placed", []))
        added = model.equal(group=self.groups[entry.get("group", "root")])
        constraint = model.constraints[added]
        model.constraints[added] = replace(constraint, rows=rows, placed=placed, weight=entry.get("weight"))
        return str(entry.get("tag", f"#{index}"))

    def _row(self, text: str, scale: float) -> Row:
        left, relation, right = re.split(r"(==|<=|>=)", text)
        a, b = self._value(left), self._value(right)
        node = self._lift(b - a if relation == ">=" else a - b).node
        return Row(node, Relation.EQUAL if relation == "==" else Relation.AT_MOST, scale)

    def _value(self, text: str) -> Any:
        def node(found: re.Match[str]) -> str:
            if found[0] in self.names:
                return f"names[{found[0]!r}]"
            return found[0] if found[0] in self.functions else f"number({found[0]})"

        known = {"names": self.names, "number": self._lift}
        return eval(_TOKEN.sub(node, text).replace("^", "**").strip(), {**self.functions, **known})

    def _lift(self, value: E | float) -> E:
        return value if isinstance(value, E) else E(self.model.builder, self.model.builder.constant(value))

    def _function(self, name: str) -> Callable[..., E]:
        return lambda *operands: call(name, *map(self._lift, operands))

    def _extreme(self, name: str) -> Callable[..., E]:
        def of(first: E, *others: E) -> E:
            for other in others:
                first = call(name, self._lift(first), self._lift(other))
            return first

        return of


def _member(entry: Any) -> dict[str, Any]:
    return entry if isinstance(entry, dict) else {"is": entry}
