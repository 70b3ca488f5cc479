"""The grammar as tables: the LALR(1) automaton of `grammar/aidl.lark`, worked out once by `construction.py`.

They are kept as JSON: an installation brings them along and needs neither the construction nor Lark itself, a
checkout makes them anew when the grammar has changed (`resources.derived`).
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import field
from functools import cache
from pathlib import Path

from aidl_lang.common.records import record
from aidl_lang.common.resources import derived, resource

DERIVED = "tables.json"


@record(slots=True)
class Rule:
    """A production: `size` symbols become one `origin`.

    `action` names the builder's method for it. Without one the rule makes no node: `passes` is the position
    of the one symbol whose value it hands on, or None where it gathers the values of its symbols in a list.
    `kept` are the positions of the symbols that have a value.
    """

    origin: str
    size: int
    action: str | None
    passes: int | None
    kept: tuple[int, ...]


@record(eq=False)
class Tables:
    """An LALR(1) automaton. Terminals go by their text where it is fixed (`==`, `param`), else by their name;
    the symbols of the grammar's rules stand in angle brackets (`<param>`).

    `actions[state][symbol]` is a state to go to, or `~r` (negative) for a reduction by `rules[r]`.
    `reserved` are the words that CALL leaves out, `soft_words` those that are names wherever the grammar has
    no place for them; in `statement_states` a statement may begin. `steps` is filled while parsing.
    """

    start: int
    end: int
    actions: tuple[dict[str, int], ...]
    rules: tuple[Rule, ...]
    patterns: dict[str, str]
    ignored: tuple[str, ...]
    literals: frozenset[str]
    reserved: frozenset[str]
    soft_words: frozenset[str]
    statement_states: frozenset[int]
    steps: dict[tuple[int, int, str], int] = field(default_factory=dict)


@cache
def load_tables() -> Tables:
    """Returns the tables of the grammar of this installation, or of this checkout as it stands."""
    return decoded(derived(DERIVED, _inputs, built))


def built() -> bytes:
    """Returns the tables as data. Raises lark's GrammarError if the grammar cannot be read."""
    from aidl_lang.syntax.construction import build_tables

    return encoded(build_tables(resource("grammar/aidl.lark").read_text(encoding="utf-8")))


def _inputs() -> Iterator[Path]:
    """Yields the files that the tables depend on."""
    here = Path(__file__).parent
    yield from (here / name for name in ("tables.py", "construction.py"))
    yield resource("grammar/aidl.lark")


def encoded(tables: Tables) -> bytes:
    """Returns the tables as JSON. A state groups its reductions by the sets of symbols before which they are
    made: there are few such sets, and they are most of an automaton.
    """
    sets: dict[tuple[str, ...], int] = {}
    states: list[list[object]] = []
    for row in tables.actions:
        before: dict[int, list[str]] = {}
        for symbol, target in row.items():
            if target < 0:
                before.setdefault(target, []).append(symbol)
        reductions = [(target, sets.setdefault(tuple(found), len(sets))) for target, found in before.items()]
        states.append([{s: t for s, t in row.items() if t >= 0}, *(x for pair in reductions for x in pair)])
    data = json.dumps(
        {
            "start": tables.start,
            "end": tables.end,
            "states": states,
            "sets": list(sets),
            "rules": [(r.origin, r.size, r.action, r.passes, r.kept) for r in tables.rules],
            "patterns": tables.patterns,
            "ignored": tables.ignored,
            "literals": sorted(tables.literals),
            "reserved": sorted(tables.reserved),
            "soft_words": sorted(tables.soft_words),
            "statement_states": sorted(tables.statement_states),
        },
        separators=(",", ":"),
    )
    return data.encode()


def decoded(text: bytes) -> Tables:
    """Returns the tables that `encoded` turned into JSON."""
    data = json.loads(text)
    sets: list[list[str]] = data["sets"]
    actions: list[dict[str, int]] = []
    for row, *reductions in data["states"]:
        for i in range(0, len(reductions), 2):
            row.update(dict.fromkeys(sets[reductions[i + 1]], reductions[i]))
        actions.append(row)
    return Tables(
        start=data["start"],
        end=data["end"],
        actions=tuple(actions),
        rules=tuple(Rule(o, n, action, passes, tuple(kept)) for o, n, action, passes, kept in data["rules"]),
        patterns=data["patterns"],
        ignored=tuple(data["ignored"]),
        literals=frozenset(data["literals"]),
        reserved=frozenset(data["reserved"]),
        soft_words=frozenset(data["soft_words"]),
        statement_states=frozenset(data["statement_states"]),
    )
