"""Explanations of tokens that cannot stand: questions are asked in order, the more particular first."""

from __future__ import annotations

from collections.abc import Callable

from aidl_lang.common.diagnostics import Label
from aidl_lang.common.prose import listed
from aidl_lang.syntax import foreign, missing, rewriting, spelling
from aidl_lang.syntax.automaton import SyntaxProblem, Trouble, wrong
from aidl_lang.syntax.tables import END, describe

_QUESTIONS: tuple[Callable[[Trouble], SyntaxProblem | None], ...] = (
    foreign.prose,
    foreign.import_of_module,
    foreign.documentation_text,
    foreign.inches,
    foreign.question_mark,
    spelling.unclosed_comment,
    spelling.unclosed_string,
    spelling.unknown_unit,
    spelling.foreign_character,
    foreign.foreign_loop,
    rewriting.arrow_function,
    foreign.object_literal,
    foreign.loose_point,
    foreign.word_for_sign,
    foreign.several_names,
    spelling.operator_spelling,
    spelling.spaced_unit,
    spelling.foreign_statement,
    missing.nameless_structure,
    missing.repeated_placement,
    missing.out_of_place_in_constrain,
    missing.placement_in_expression,
    spelling.reserved_word,
    missing.else_without_if,
    missing.unclosed_arguments,
    missing.comma_before_block,
    missing.name_in_block,
    missing.choice_in_block,
    missing.wrong_closer,
    missing.unclosed_block,
    missing.equation_for_definition,
    missing.definition_for_equation,
    missing.colon_for_equals,
    missing.semicolons,
    missing.unclosed_bracket,
    missing.three_coordinates,
    missing.missing_comma,
    missing.missing_equals,
    missing.typed_definition,
    missing.choice_without_parentheses,
    missing.import_without_path,
    missing.missing_value,
    foreign.indented_block,
    missing.missing_block,
    missing.bare_value,
    missing.attribute_out_of_place,
    missing.stray_closer,
    missing.stray_comma,
)

# Names of what could come next, the most useful first.
_EXPECTED = (
    ("a value", ("NUMBER",)),
    ("a name", ("NAME",)),
    ("`=`", ("=",)),
    ("`{`", ("{",)),
    ("`in`", ("in",)),
    ("`else`", ("else",)),
    ("`then`", ("then",)),
    ("`,`", (",",)),
    ("`)`", (")",)),
    ("`]`", ("]",)),
    ("a comparison such as `==`", ("==",)),
    ("an operator", ("+",)),
)


def explain(trouble: Trouble) -> SyntaxProblem:
    """Returns the first answer to the questions, or a problem that names the token and what could stand."""
    for question in _QUESTIONS:
        if (problem := question(trouble)) is not None:
            return problem
    return _unexpected(trouble)


def _unexpected(t: Trouble) -> SyntaxProblem:
    possible = [words for words, kinds in _EXPECTED if t.accepts(*kinds)]
    if "a name" in possible and "`then`" in possible:
        possible.remove("`then`")  # which would be a name here
    if t.between:
        message = f"a statement cannot begin with {describe(t.token)}"
        possible = []
    elif t.complete:
        message = f"{describe(t.token)} cannot stand here: the statement before it is complete"
    else:
        if possible[:2] == ["a value", "a name"]:
            del possible[1]
        possible = possible[:3]
        expected = listed(possible, last="or")
        place = describe(t.token) if t.token.kind != END else "the end of the file"
        message = f"expected {expected}, not {place}" if expected else f"{place} cannot stand here"
    secondary = (Label(t.span(t.first), "in the statement that begins here"),) if not t.between else ()
    return wrong("E0101", message, t.span(), secondary=secondary)
