"""Hypothesis strategies for syntax trees, as `parse` would make them from canonical text."""

from __future__ import annotations

from functools import partial

from hypothesis import strategies as st

from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import KINDS

NOWHERE = Span(SourceFile("<made up>", ""), 0, 0)

# Ordinary names, names of kinds, units and shapes, and the words that are reserved in one place only.
NAMES = [
    "a",
    "b",
    "width",
    "left_ear",
    "solid",
    "hole",
    "mm",
    "circle",
    "x2",
    "self",
    "then",
    "from",
    "größe",
]


def _node(kind: type[ast.Node], *parts: st.SearchStrategy[object]) -> st.SearchStrategy[ast.Node]:
    return st.builds(partial(kind, span=NOWHERE), *parts)


names = st.sampled_from(NAMES)
identifiers = _node(ast.Identifier, names)


def _tuples(items: st.SearchStrategy[ast.Node], least: int = 0, most: int = 3) -> st.SearchStrategy[object]:
    return st.lists(items, min_size=least, max_size=most).map(tuple)


@st.composite
def numbers(draw: st.DrawFn) -> ast.Number:
    text = draw(st.sampled_from(["0", "5", "0.5", "12.75", "1e3", "2.5e-3", ".25", "100"]))
    unit = draw(st.sampled_from([None, None, "mm", "cm", "m", "in", "ft", "deg", "rad", "turn"]))
    return ast.Number(float(text), unit, text, span=NOWHERE)


texts = st.text(st.characters(codec="utf-8", exclude_categories=["Cs"]), max_size=6)
leaves = numbers() | _node(ast.Name, names) | _node(ast.String, texts) | _node(ast.Boolean, st.booleans())


def _run_through(inner: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    """What a loop runs through: there a range may have a step."""
    return inner | _node(ast.Range, inner, inner, st.booleans(), inner)


def _compound(inner: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    maybe = st.none() | inner
    argument = _node(ast.Argument, st.none() | identifiers, inner)
    comparison = st.integers(2, 3).flatmap(
        lambda n: _node(
            ast.Comparison,
            st.tuples(*[inner] * n),
            st.tuples(*[st.sampled_from(["==", "!=", "<=", ">=", "<", ">"])] * (n - 1)),
        )
    )
    return st.one_of(
        _node(ast.Member, inner, identifiers),
        _node(ast.Index, inner, inner),
        _node(ast.Call, identifiers, maybe, _tuples(argument)),
        _node(ast.Point, inner, inner),
        _node(ast.List, _tuples(inner)),
        _node(ast.Comprehension, inner, _tuples(identifiers, 1, 2), _run_through(inner), maybe),
        _node(ast.Unary, st.sampled_from(["-", "+", "not"]), inner),
        _node(ast.Binary, st.sampled_from(["+", "-", "*", "/", "%", "^", "and", "or"]), inner, inner),
        comparison,
        _node(ast.Membership, inner, inner),
        _node(ast.Range, inner, inner, st.booleans()),
        _node(ast.Conditional, inner, inner, inner),
    )


expressions = st.recursive(leaves, _compound, max_leaves=8)
simple = st.recursive(leaves, _compound, max_leaves=3)
calls = _node(
    ast.Call,
    identifiers,
    st.none() | _node(ast.Name, names) | _node(ast.Member, _node(ast.Name, names), identifiers),
    _tuples(_node(ast.Argument, st.none() | identifiers, simple)),
)

maybe_simple = st.none() | simple
no_doc = st.none()
parameters = _tuples(_node(ast.Parameter, identifiers, st.none() | identifiers, maybe_simple))
attributes = _tuples(
    _node(ast.Attribute, identifiers, _tuples(_node(ast.Argument, st.none() | identifiers, simple), 0, 2)),
    0,
    2,
)
placements = st.none() | st.tuples(maybe_simple, maybe_simple).filter(any).map(
    lambda parts: ast.Placement(*parts, span=NOWHERE)
)
lets = _node(ast.Let, identifiers, expressions, no_doc)
prefers = _node(ast.Prefer, expressions, maybe_simple)
constrains = expressions.map(
    lambda e: ast.Constrain(
        ast.Block((ast.ExpressionStatement(e, span=NOWHERE),), span=NOWHERE), False, span=NOWHERE
    )
)


def _is_no_pair(node: ast.Assert) -> bool:
    """`assert (test, "why")` is read as a test and its reason, not as a point."""
    return not isinstance(node.test, ast.Point) or node.message is not None


plain_statements = st.one_of(
    _node(ast.Param, identifiers, simple, maybe_simple, maybe_simple, no_doc),
    _node(ast.Var, identifiers, expressions, no_doc),
    lets,
    _node(
        ast.Assign,
        identifiers,
        _tuples(simple, 0, 2),
        expressions,
        placements,
        st.booleans(),
        attributes,
        no_doc,
    ),
    _node(ast.ExpressionStatement, calls),
    constrains,
    prefers,
    _node(ast.Assert, expressions, maybe_simple).filter(_is_no_pair),
    _node(ast.Import, _node(ast.String, texts), st.none() | identifiers, st.just(())),
    _node(ast.Import, _node(ast.String, texts), st.none(), _tuples(identifiers, 1, 2)),
    _node(ast.FunctionDefinition, identifiers, parameters, expressions, no_doc),
    _node(ast.Alias, identifiers, identifiers, no_doc),
    _node(ast.Todo),
)  # fmt: skip


def _blocks(statement: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    return _node(ast.Block, _tuples(statement))


def _control(statement: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    block = _blocks(statement)
    return _node(ast.For, _tuples(identifiers, 1, 2), _run_through(simple), block) | _node(
        ast.If, expressions, block, st.none() | block
    )


constraint_items = st.recursive(
    _node(ast.ExpressionStatement, expressions) | lets | prefers, _control, max_leaves=4
)


def _structures(statement: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    kind, block = st.sampled_from(KINDS), _blocks(statement)
    plain = st.tuples(_tuples(simple, 0, 2), st.none())
    template = st.tuples(st.just(()), parameters)

    @st.composite
    def structure(draw: st.DrawFn) -> ast.Structure:
        word = draw(kind)
        indices, template_parameters = draw(plain | template)
        return ast.Structure(
            word,
            ast.Identifier(word, span=NOWHERE),
            draw(identifiers),
            indices,
            template_parameters,
            draw(placements),
            draw(attributes),
            draw(block),
            None,
            span=NOWHERE,
        )

    return structure()


def _nested(statement: st.SearchStrategy[ast.Node]) -> st.SearchStrategy[ast.Node]:
    return st.one_of(
        _structures(statement),
        _control(statement),
        _node(ast.ShapeDefinition, identifiers, parameters, _blocks(statement), no_doc),
    )


block_constrains = _blocks(constraint_items).map(lambda b: ast.Constrain(b, True, span=NOWHERE))
constraint_definitions = _node(
    ast.ConstraintDefinition, identifiers, parameters, _blocks(constraint_items), no_doc
)
statements = st.recursive(plain_statements | block_constrains | constraint_definitions, _nested, max_leaves=5)
modules = st.lists(statements, max_size=4).map(
    lambda found: ast.Module(NOWHERE.source, tuple(found), (), span=NOWHERE)
)
