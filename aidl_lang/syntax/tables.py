"""The grammar as tables: Lark reads `grammar/aidl.lark` and works out the LALR(1) automaton, once.

The result is plain data, kept in the user's cache folder under a key made of everything it depends on, so
that later runs need neither the construction nor Lark itself. A cache that cannot be read or written costs
time and nothing else.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import pickle
import re
import sys
import tempfile
from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.resources import resource

if TYPE_CHECKING:
    from lark.grammar import Rule as LarkRule


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, eq=False)
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
    """The tables of the installed grammar, from the cache if it holds them."""
    grammar = resource("grammar/aidl.lark").read_text(encoding="utf-8")
    path = cache_path(grammar)
    if (tables := _read(path)) is None:
        tables = build_tables(grammar)
        _write(path, tables)
    return tables


def cache_path(grammar: str) -> Path:
    """The file that holds the tables of this grammar for this code, this Python and this Lark."""
    spec = importlib.util.find_spec("lark")
    lark = spec.origin if spec and spec.origin else ""
    stamp = os.stat(lark).st_mtime_ns if lark else 0
    code = Path(__file__).read_bytes()  # what the tables look like is decided here
    key = repr((code, sys.version_info, lark, stamp, grammar)).encode()
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "aidl" / f"grammar-{hashlib.sha256(key).hexdigest()[:32]}.pickle"


def _read(path: Path) -> Tables | None:
    try:
        tables = pickle.loads(path.read_bytes())
    except (
        OSError,
        pickle.UnpicklingError,
        EOFError,
        AttributeError,
        ImportError,
        LookupError,
        ValueError,
        TypeError,
    ):
        return None
    whole = isinstance(tables, Tables) and vars(tables).keys() == {f.name for f in fields(Tables)}
    return tables if whole else None


def _write(path: Path, tables: Tables) -> None:
    """Write beside the file and move into place, so that no reader ever sees half of it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
            file.write(pickle.dumps(tables, protocol=pickle.HIGHEST_PROTOCOL))
        os.replace(file.name, path)
    except OSError:
        return  # a read-only or full home: the next run builds the tables again


def build_tables(grammar: str) -> Tables:
    """Have Lark read the grammar (about half a second). Raises lark's GrammarError on a conflict."""
    from lark import Lark
    from lark.lexer import PatternStr
    from lark.parsers.lalr_analysis import Shift

    parser = Lark(grammar, parser="lalr", strict=True, start="module", maybe_placeholders=False)
    table = parser.parser.parser._parse_table
    text_of = {
        t.name: t.pattern.value if isinstance(t.pattern, PatternStr) else t.name for t in parser.terminals
    }
    text_of["$END"] = "$END"
    rules = {rule: number for number, rule in enumerate(parser.rules)}
    numbers = {state: number for number, state in enumerate(sorted(table.states))}
    actions: list[dict[str, int]] = [{} for _ in numbers]
    for state, row in table.states.items():
        for symbol, (kind, target) in row.items():
            actions[numbers[state]][text_of.get(symbol) or f"<{symbol}>"] = (
                numbers[target] if kind is Shift else ~rules.setdefault(target, len(rules))
            )
    patterns = {
        t.name: t.pattern.to_regexp() for t in parser.terminals if not isinstance(t.pattern, PatternStr)
    }
    literals = frozenset(t.pattern.value for t in parser.terminals if isinstance(t.pattern, PatternStr))
    call = re.compile(patterns["CALL"])
    words = {w for w in literals if w.isidentifier()}
    soft = frozenset(w for w in words if call.fullmatch(w + "("))
    return Tables(
        start=numbers[table.start_states["module"]],
        end=numbers[table.end_states["module"]],
        actions=tuple(actions),
        rules=tuple(map(_plain_rule, rules)),
        patterns=patterns,
        ignored=tuple(parser.ignore_tokens),
        literals=literals,
        reserved=frozenset(words - soft),
        soft_words=soft,
        statement_states=frozenset(n for n, row in enumerate(actions) if row.get(";", -1) >= 0),
    )


def _plain_rule(rule: LarkRule) -> Rule:
    """What Lark's own tree builder would make of a rule: `?`, `!`, `_` and `->` mean what they mean there."""
    from lark.grammar import Terminal

    origin, expansion = str(rule.origin.name), rule.expansion
    options, alias = rule.options, rule.alias
    dropped = [isinstance(symbol, Terminal) and symbol.filter_out for symbol in expansion]
    kept = tuple(i for i, drop in enumerate(dropped) if options.keep_all_tokens or not drop)
    gathers = origin.startswith("_")
    passes = kept[0] if len(kept) == 1 and not gathers and options.expand1 and not alias else None
    action = None if gathers or passes is not None else str(alias or origin)
    return Rule(f"<{origin}>", len(expansion), action, passes, kept)
