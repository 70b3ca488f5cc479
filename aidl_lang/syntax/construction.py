"""The construction of the parser's tables: Lark reads `grammar/aidl.lark` and works out the LALR(1)
automaton.

Runs when the package is built and, in a checkout, when the grammar has changed; never at a user's. Tests show
that the grammar is strictly LALR(1), and that no two terminals overlap.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from aidl_lang.syntax.tables import Rule, Tables

if TYPE_CHECKING:
    from lark.grammar import Rule as LarkRule


def build_tables(grammar: str) -> Tables:
    """Has Lark read the grammar (about half a second). Raises lark's GrammarError if it cannot."""
    from lark import Lark
    from lark.lexer import PatternStr
    from lark.parsers.lalr_analysis import Shift

    parser = Lark(grammar, parser="lalr", start="module", maybe_placeholders=False)
    table = parser.parser.parser._parse_table
    text_of = {
        t.name: t.pattern.value if isinstance(t.pattern, PatternStr) else t.name for t in parser.terminals
    }
    text_of["$END"] = "$END"
    rules = {rule: number for number, rule in enumerate(parser.rules)}
    # Lark's numbers of states follow the order of its sets, which changes from run to run.
    start = table.start_states["module"]
    numbers = {start: 0}
    actions: list[dict[str, int]] = []
    for state in (waiting := [start]):
        actions.append(row := {})
        for symbol, (kind, target) in sorted(table.states[state].items()):
            if kind is Shift and target not in numbers:
                numbers[target] = len(numbers)
                waiting.append(target)
            row[text_of.get(symbol) or f"<{symbol}>"] = (
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
        start=numbers[start],
        end=numbers[table.end_states["module"]],
        actions=tuple(actions),
        rules=tuple(map(_plain_rule, rules)),
        patterns=patterns,
        ignored=tuple(parser.ignore_tokens),
        literals=literals,
        reserved=frozenset(words - soft),
        soft_words=soft,
        statement_states=frozenset(n for n, row in enumerate(actions) if _may_begin_statement(row)),
    )


def _may_begin_statement(row: dict[str, int]) -> bool:
    """Tells whether a statement may begin in a state; a `;` may stand among arguments in a block too."""
    return row.get(";", -1) >= 0 and row.get("prefer", -1) >= 0


def _plain_rule(rule: LarkRule) -> Rule:
    """Returns a rule that builds what Lark's own tree builder would: `?`, `!`, `_` and `->` mean what they
    mean there.
    """
    from lark.grammar import Terminal

    origin, expansion = str(rule.origin.name), rule.expansion
    options, alias = rule.options, rule.alias
    dropped = [isinstance(symbol, Terminal) and symbol.filter_out for symbol in expansion]
    kept = tuple(i for i, drop in enumerate(dropped) if options.keep_all_tokens or not drop)
    gathers = origin.startswith("_")
    passes = kept[0] if len(kept) == 1 and not gathers and options.expand1 and not alias else None
    action = None if gathers or passes is not None else str(alias or origin)
    return Rule(f"<{origin}>", len(expansion), action, passes, kept)
