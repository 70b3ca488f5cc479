"""The calls of a name in as few short forms as possible, for the guide."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import Entry
from aidl_lang.tools.reference.signatures import gathers, split_items, things, written

_PARAMETER = re.compile(r"(\w+)(?:\s*:\s*\w+)?(\?|\s*=.*)?$")


def short(form: str) -> str:
    """Returns a head without types and defaults: `ring(center?, outer_radius, inner_radius)`; words of the
    language stay as they are.
    """
    name, bracket, inside = form.partition("(")
    if not bracket or not inside.endswith(")"):
        return form
    items = []
    for item in split_items(inside[:-1]):
        found = _PARAMETER.match(item)
        items.append(found[1] + ("?" if found[2] else "") if found else item)
    return f"{name}({', '.join(items)})"


def short_calls(entry: Entry) -> list[str]:
    return short_forms([o.form for o in entry.overloads], entry.nodes)


def short_forms(forms: Sequence[str], nodes: Sequence[ast.Callable]) -> list[str]:
    """Returns the calls of a name in as few short forms as possible: constraints that differ in the types of
    what they relate share one, and so do functions that differ in types, or in the name of one argument.
    """
    constraints = [n for n in nodes if isinstance(n, ast.ConstraintDefinition)]
    functions = [n for n in nodes if isinstance(n, ast.FunctionDefinition)]
    merged = {*map(written, constraints), *map(written, functions)}
    others = [short(form) for form in forms if form not in merged]
    return list(dict.fromkeys([*others, *_merged_forms(constraints), *_merged_calls(functions)]))


@dataclass
class _Row:
    """Forms that differ in the name of one argument: the names at that `place` are joined by `/`."""

    kinds: tuple[str, ...]
    names: list[str]
    place: int | None = None

    def takes(self, kinds: tuple[str, ...], names: Sequence[str]) -> bool:
        """True if this row covers a form: types are not distinguished."""
        if len(names) != len(self.names):
            return False
        differing = [i for i, name in enumerate(names) if name not in self.names[i].split("/")]
        if not differing:
            return True
        if kinds != self.kinds or len(differing) > 1 or self.place not in (None, differing[0]):
            return False
        self.place = differing[0]
        self.names[self.place] += f"/{names[self.place]}"
        return True


def _merged_calls(functions: Sequence[ast.FunctionDefinition]) -> list[str]:
    rows: list[_Row] = []
    for node in functions:
        kinds = tuple(p.type.text if p.type is not None else "" for p in node.parameters)
        names = split_items(short(written(node)).partition("(")[2].removesuffix(")"))
        if not any(row.takes(kinds, names) for row in rows):
            rows.append(_Row(kinds, names))
    options: list[_Options] = [
        tuple((name.removesuffix("?"), not name.endswith("?")) for name in row.names) for row in rows
    ]
    return [f"{functions[0].name.text}({_listed(row)})" for row in _joined(options, _with_last_optional)]


def _merged_forms(constraints: Sequence[ast.ConstraintDefinition]) -> list[str]:
    groups: dict[object, list[ast.ConstraintDefinition]] = {}
    for node in constraints:
        groups.setdefault("list" if gathers(node) else len(things(node)), []).append(node)
    if "list" in groups:
        groups.pop(2, None)
    return [form for group in groups.values() for form in _merged(group)]


def _merged(group: Sequence[ast.ConstraintDefinition]) -> list[str]:
    """Returns the calls of constraints that relate as many things, in as few forms as say it exactly.

    An option that may be left out has a `?`; one that stands for another is joined to it by `/`.
    """
    related = [p.name.text for p in things(group[0])]
    if gathers(group[0]) and "b" not in related:
        related[0] = "a, b, …"
    options = [[p for p in node.parameters if p not in things(node)] for node in group]
    rows = list(dict.fromkeys(tuple((p.name.text, p.default is None) for p in each) for each in options))
    for join in (_of_the_same, _with_optional, _with_alternative):
        rows = _joined(rows, join)
    return [f"{group[0].name.text}({', '.join(filter(None, [*related, _listed(row)]))})" for row in rows]


_Options: TypeAlias = tuple[tuple[str, bool], ...]
"""Names of options in their order, each with whether it is needed."""
_Join: TypeAlias = Callable[[_Options, _Options], _Options | None]


def _listed(row: _Options) -> str:
    return ", ".join(name if needed else f"{name}?" for name, needed in row)


def _joined(rows: Sequence[_Options], join: _Join) -> list[_Options]:
    """Returns the rows with each two that can be joined as one."""
    done: list[_Options] = []
    for row in rows:
        for number, other in enumerate(done):
            if (both := join(other, row)) is not None:
                done[number] = both
                break
        else:
            done.append(row)
    return done if len(done) == len(rows) else _joined(done, join)


def _of_the_same(one: _Options, other: _Options) -> _Options | None:
    """Joins two rows of the same options, some of them needed in one row alone."""
    if [name for name, _ in one] != [name for name, _ in other]:
        return None
    return tuple((name, needed and also) for (name, needed), (_, also) in zip(one, other, strict=True))


def _with_optional(one: _Options, other: _Options) -> _Options | None:
    """Joins two rows of which one has an option more."""
    short, long = sorted((one, other), key=len)
    more = [word for word in long if word not in short]
    if len(long) != len(short) + 1 or len(more) != 1 or [word for word in long if word in short] != [*short]:
        return None
    return tuple((name, needed and (name, needed) != more[0]) for name, needed in long)


def _with_last_optional(one: _Options, other: _Options) -> _Options | None:
    """Joins two rows of which one has an option more, behind all that is needed and by one name."""
    both = _with_optional(one, other)
    optional = [name for name, needed in both or () if not needed]
    is_last = both is not None and [name for name, _ in both[-len(optional) :]] == optional
    return both if is_last and not any("/" in name for name in optional) else None


def _with_alternative(one: _Options, other: _Options) -> _Options | None:
    """Joins two rows that differ in the name of one option."""
    differing = [i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b]
    if len(one) != len(other) or len(differing) != 1 or one[differing[0]][1] != other[differing[0]][1]:
        return None
    (k,) = differing
    return (*one[:k], (f"{one[k][0]}/{other[k][0]}", one[k][1]), *one[k + 1 :])
