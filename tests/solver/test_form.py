"""Problem files: reading, writing, mistakes, and the command that solves them."""

from __future__ import annotations

import contextlib
import copy
import itertools
import json
import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.building.lower import lower
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.interp import interpret
from aidl_lang.solver import Problem, Relation, solve
from aidl_lang.solver.operations import Op
from tests.amount import tries
from tests.documents import ROOT, blocks
from tests.solver.problems.__main__ import main
from tests.solver.problems.form import LEVELS, Case, FormError, dump, load, read
from tests.solver.problems.notation import DEEPEST, LONGEST_TEXT

from .build import Model, call
from .check import evaluate

EXAMPLES = sorted((ROOT / "examples").glob("*.aidl"))
CORPUS = sorted((Path(__file__).parent / "corpus").glob("*.json"))
PAGE = list(blocks(ROOT / "tests" / "solver" / "problems" / "README.md"))


def _lowered(path: Path) -> Problem:
    source = SourceFile(path.name, path.read_text(encoding="utf-8"))
    program, _ = pipeline.front(source, DiskWorld(path.parent))
    return lower(interpret(program).model).problem


def _again(problem: Problem) -> Problem:
    return read(json.dumps(dump(problem))).problem


def _structure(problem: Problem) -> tuple[object, ...]:
    """Everything about a problem that can influence a solve, independent of nodes that nothing uses."""
    tape = problem.tape
    roots = [*problem.rows.expression.tolist(), *(node for _, node in problem.observables)]
    used, stack = set(roots), list(roots)
    while stack:
        node = stack.pop()
        fresh = set(tape.operand_lists[node]) - used if tape.op_list[node] > Op.UNKNOWN else set()
        used |= fresh
        stack.extend(fresh)
    known: dict[int, object] = {}
    operations = []
    for node in sorted(used):
        op, operands = tape.op_list[node], tape.operand_lists[node]
        if op == Op.CONSTANT:
            known[node] = float(tape.constants[node])
        elif op == Op.UNKNOWN:
            known[node] = ("unknown", operands[0])
        else:
            parts = [known[operand] for operand in operands]
            operations.append((op, *(sorted(parts, key=repr) if op in (Op.ADD, Op.MUL) else parts)))
            known[node] = ("operation", len(operations))
    fields = ("initial", "scale", "kept", "group", "frame_of", "parent", "holder", "weight", "placed")
    arrays = [getattr(problem, field).tolist() for field in fields]
    longest = None if problem.longest is None or np.isinf(problem.longest).all() else problem.longest.tolist()
    rows = [
        problem.rows.at_most.tolist(), problem.rows.scale.tolist(), problem.rows.constraint.tolist(),
        [known[node] for node in problem.rows.expression.tolist()],
    ]  # fmt: skip
    seen = [(group, known[node]) for group, node in problem.observables]
    return operations, repr(arrays), longest, rows, seen


class TestTheWayBack:
    @pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
    def test_a_drawing_is_solved_to_the_same_digits(self, path: Path) -> None:
        problem = _lowered(path)
        again = _again(problem)
        assert _structure(again) == _structure(problem)
        assert again.names == problem.names
        assert solve(again).values.tobytes() == solve(problem).values.tobytes()

    @pytest.mark.parametrize("path", CORPUS, ids=lambda path: path.stem)
    def test_a_case_stays_the_same(self, path: Path) -> None:
        problem = read(path.read_text(encoding="utf-8")).problem
        assert _structure(_again(problem)) == _structure(problem)

    def test_operands_keep_their_order_where_it_decides(self) -> None:
        """At a tie `min` takes its first operand: here the unknown, which is on the tape before the rest."""
        m = Model()
        x, y, z = (m.unknown(v) for v in (0.0, 0.0, 3.0))
        shared = z - 3.0
        m.equal(call("minimum", x, shared) - 1.0)
        m.equal(call("maximum", y, shared) - 2.0, shared * 5.0)
        problem = m.problem()
        assert _structure(_again(problem)) == _structure(problem)

    def test_what_is_used_twice_is_written_once(self) -> None:
        m = Model()
        x = m.unknown(2.0)
        power = x
        for _ in range(300):  # written out, this would have 2 ** 300 operands
            power = power * power - power
        m.at_most(power)
        text = json.dumps(dump(m.problem()))
        assert len(text) < 20_000
        assert _structure(read(text).problem) == _structure(m.problem())

    def test_names_that_cannot_be_are_replaced(self) -> None:
        problem = load(
            {"unknowns": dict.fromkeys("abcde", 0.0), "constraints": ["a + b + c + d + e == 1"]}
        ).problem
        names = ("max", "a.x", "a.x", "two words", "u0")
        renamed = Problem(**{**vars(problem), "names": names})
        assert list(dump(renamed)["unknowns"]) == ["u1", "u2", "u3", "u4", "u0"]  # type: ignore[call-overload]

    def test_tags_are_given_along(self) -> None:
        problem = load({"unknowns": {"x": 0}, "constraints": ["x >= 1", "x <= 2"]}).problem
        assert load(dump(problem, "two bounds", ["low", "high"])).tags == ("low", "high")

    def test_a_constant_that_is_too_large_is_refused(self) -> None:
        m = Model()
        m.equal(m.unknown(0.0) - 1e200)
        with pytest.raises(FormError, match="node 1: a number between"):
            dump(m.problem())

    @pytest.mark.parametrize("number", [math.nan, math.inf, 1e200])
    def test_what_is_no_number_is_refused(self, number: float) -> None:
        m = Model()
        m.equal(m.unknown(0.0) - 1.0)
        m.initial[0] = number
        with pytest.raises(FormError, match="unknown 'u0': a number between"):
            dump(m.problem())


# ---- expressions ---------------------------------------------------------------------------------------

_VALUES = {"a": 0.7, "b.x": -1.3, "c[2].y": 2.0}
_UNARY = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "abs": abs, "square": lambda v: v * v}
_BINARY = {"atan2": math.atan2, "hypot": math.hypot, "min": min, "max": max}
_MEANING: dict[str, Any] = {
    **_UNARY, **_BINARY, "sqrt": math.sqrt, "asin": math.asin, "acos": math.acos, "pi": math.pi,
    "select": lambda c, a, b: a if c >= 0 else b,
    "a": _VALUES["a"], "b": SimpleNamespace(x=_VALUES["b.x"]), "c": {2: SimpleNamespace(y=_VALUES["c[2].y"])},
}  # fmt: skip


_LEAF = re.compile(r"\b(?:pi|a|b\.x|c\[2\]\.y)\b|(?<![\w.\[])(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?")


def _expressions() -> st.SearchStrategy[str]:
    leaves = st.sampled_from([*_VALUES, "pi", "3", "0.5", ".25", "2.5e-1", "1."])
    spaces = st.sampled_from(["", " ", "  "])

    def larger(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        return st.one_of(
            st.builds("{}{}{}{}".format, inner, spaces, st.sampled_from("+-*/%^"), inner),
            st.builds("-{}".format, inner),
            st.builds("({}{})".format, inner, spaces),
            st.builds("{}({})".format, st.sampled_from([*_UNARY, "sqrt", "asin", "acos"]), inner),
            st.builds("{}({},{} {})".format, st.sampled_from([*_BINARY]), inner, spaces, inner),
            st.builds("min({}, {}, {})".format, inner, inner, inner),
            st.builds("select({}, {}, {})".format, inner, inner, inner),
        )

    return st.recursive(leaves, larger, max_leaves=12)


def _value(text: str) -> float:
    """What Python makes of an expression; those that have no value are not tried, nor those on a jump, where
    rounding decides: they change much if every number in them changes a little.
    """
    try:
        values = [_value_near(text, change) for change in (0.0, 1e-9, -1e-9)]
    except (ArithmeticError, ValueError, TypeError):  # the last for complex numbers
        assume(False)
    assume(all(isinstance(value, float) and abs(value) < 1e6 for value in values))
    assume(max(values) - min(values) < 1e-4)
    return float(values[0])


def _value_near(text: str, change: float) -> Any:
    """With every leaf changed by a part of `change`, each by another."""
    turns = itertools.count(1)
    near = _LEAF.sub(lambda leaf: f"({leaf[0]} * {1.0 + change * (next(turns) * 0.618 % 1.0)!r})", text)
    return eval(near.strip().replace("^", "**"), {}, _MEANING)


class TestExpressions:
    @given(_expressions(), st.sampled_from(["==", "<=", ">="]), _expressions())
    @tries(200)
    @example("-3 ^ 2", "==", "2 ^ -1 ^ 2")
    @example("a - b.x - 3 + a", "==", "2 / 3 * 4 % 3 - -a")
    @example("2 ^ 3 ^ 2", ">=", "0")
    @example("a", "<=", " 0 ")
    def test_they_mean_what_python_makes_of_them(self, left: str, relation: str, right: str) -> None:
        sides = [_value(left), _value(right)]
        problem = load({"unknowns": _VALUES, "constraints": [f"{left} {relation} {right}"]}).problem
        ((row,),) = (constraint.rows for constraint in problem.constraints)
        with np.errstate(all="ignore"):
            value = evaluate(problem, row.expression, problem.initial)
        difference = sides[1] - sides[0] if relation == ">=" else sides[0] - sides[1]
        assert value == pytest.approx(difference, rel=1e-9, abs=1e-9)
        assert row.relation is (Relation.EQUAL if relation == "==" else Relation.AT_MOST)

    def test_a_name_may_be_anything_that_paths_are(self) -> None:
        case = load(
            {"unknowns": {"größe": 1, "_a1.b[0][12].c": 2}, "constraints": ["größe == _a1.b[0][12].c"]}
        )
        assert case.problem.names == ("größe", "_a1.b[0][12].c")

    @pytest.mark.parametrize(
        "deep", ["(" * (DEEPEST - 1) + "x" + ")" * (DEEPEST - 1), "-" * (DEEPEST - 1) + "x"]
    )
    def test_nesting_has_a_limit(self, deep: str) -> None:
        load({"unknowns": {"x": 1}, "constraints": [f"{deep} == 0"]})
        with pytest.raises(FormError, match=f"nested deeper than {DEEPEST} levels"):
            load({"unknowns": {"x": 1}, "constraints": [f"-({deep}) == 0"]})

    def test_long_sums_are_no_nesting(self) -> None:
        problem = load({"unknowns": {"x": 0}, "constraints": ["x" + " + 1" * 4000 + " == 0"]}).problem
        assert solve(problem).values.tolist() == [-4000.0]


# ---- mistakes ------------------------------------------------------------------------------------------

X = {"x": 1}
MISTAKES: list[tuple[object, str]] = [
    ([], "an object is needed, not a list"),
    (None, "an object is needed, not null"),
    ({1: 2}, "a text is needed, not a number"),
    (
        {"unknown": X},
        "no member is called 'unknown'; there are about, groups, unknowns, let, constraints, observed, expected, named",
    ),
    ({"about": 3}, "about: a text is needed, not a number"),
    ({"groups": []}, "groups: an object is needed, not a list"),
    ({"groups": {"root": "root"}}, "group 'root': the outermost group has this name already"),
    ({"groups": {"a": "b", "b": "a"}}, "group 'a': no group before it is called 'b'"),
    ({"groups": {"a": "a"}}, "group 'a': no group before it is called 'a'"),
    ({"unknowns": {"x": None}}, "unknown 'x': guess: a number is needed, not null"),
    ({"unknowns": {"x": True}}, "unknown 'x': guess: a number is needed, not true or false"),
    ({"unknowns": {"x": {}}}, "unknown 'x': 'guess' is missing"),
    ({"unknowns": {"x": math.nan}}, "unknown 'x': guess: a number between -1e+150 and 1e+150 is needed"),
    ({"unknowns": {"x": 10**400}}, "unknown 'x': guess: a number between -1e+150 and 1e+150 is needed"),
    ({"unknowns": {"x": {"guess": 1, "scale": 0}}}, "unknown 'x': scale: a number greater than 0 is needed, not 0"),
    ({"unknowns": {"x": {"guess": 1, "kept": 1}}}, "unknown 'x': kept: true or false is needed, not a number"),
    ({"unknowns": {"x": {"guess": 1, "group": "a"}}}, "unknown 'x': group: no group is called 'a'"),
    (
        {"unknowns": {"x": {"guess": 1, "frame": "root"}}},
        "unknown 'x': frame: only of a group within another, which owns it without being named",
    ),
    ({"unknowns": {"two words": 1}}, "unknown 'two words': not a name: letters, digits and '_', with parts like '.x' and '[0]'"),
    ({"unknowns": {"sin": 1}}, "unknown 'sin': the name of a function or a constant"),
    ({"unknowns": X, "let": {"x": "1"}}, "let 'x': something else has this name"),
    ({"let": {"a": "b", "b": "a"}}, "let 'a': column 1: no unknown and no let is called 'b'"),
    ({"let": {"a": 1}}, "let 'a': a text is needed, not a number"),
    ({"let": {"a": "1 == 2"}}, "let 'a': column 3: an operator or the end is needed, not '=='"),
    ({"unknowns": X, "constraints": "x == 1"}, "constraints: a list is needed, not a text"),
    ({"unknowns": X, "constraints": [{}]}, "constraints[0]: 'is' is missing"),
    ({"unknowns": X, "constraints": [{"is": "x == 1", "tag": 1}]}, "constraints[0]: tag: a text is needed, not a number"),
    (
        {"unknowns": X, "constraints": [{"tag": "a", "is": "x == 1"}, {"tag": "a", "is": "x == 1"}]},
        "constraints[1]: tag: constraints[0] has 'a' already",
    ),
    ({"constraints": [{"tag": "a", "is": ["1 == 1", "y == 1"]}]}, "constraints[0] 'a': is: [1]: column 1: no unknown and no let is called 'y'"),
    ({"constraints": ["1 + == 2"]}, "constraints[0]: is: column 5: a number, a name or '(' is needed, not '=='"),
    ({"constraints": ["1 +"]}, "constraints[0]: is: column 4: a number, a name or '(' is needed, not the end"),
    ({"constraints": [""]}, "constraints[0]: is: column 1: a number, a name or '(' is needed, not the end"),
    ({"constraints": ["1"]}, "constraints[0]: is: column 2: an operator, '==', '<=' or '>=' is needed, not the end"),
    ({"constraints": ["1 == 2 == 3"]}, "constraints[0]: is: column 8: an operator or the end is needed, not '=='"),
    ({"constraints": ["1 < 2"]}, "constraints[0]: is: column 3: '<' has no meaning here"),
    ({"constraints": ["2 ** 3 == 8"]}, "constraints[0]: is: column 4: a number, a name or '(' is needed, not '*'"),
    ({"constraints": ["(1 == 2"]}, "constraints[0]: is: column 4: an operator or ')' is needed, not '=='"),
    ({"constraints": ["max(1 == 2"]}, "constraints[0]: is: column 7: an operator or ',' or ')' is needed, not '=='"),
    ({"constraints": ["hypot(1) == 2"]}, "constraints[0]: is: column 1: hypot takes 2 operands, not 1"),
    ({"constraints": ["floor(1) == 2"]}, "constraints[0]: is: column 1: no function is called 'floor'"),
    ({"constraints": ["1e200 == 2"]}, "constraints[0]: is: column 1: '1e200' is greater than 1e+150"),
    ({"constraints": ["1" * (LONGEST_TEXT + 1)]}, "constraints[0]: is: an expression of 20001 characters; 20000 are allowed"),
    ({"unknowns": X, "constraints": [{"is": "x == 1", "placed": ["y"]}]}, "constraints[0]: placed: [0]: no unknown is called 'y'"),
    ({"constraints": [{"is": "1 == 1", "weight": -1}]}, "constraints[0]: weight: a number that is not below 0 is needed, not -1"),
    ({"constraints": [{"is": "1 == 1", "scale": [1, 2]}]}, "constraints[0]: scale: 1 or 1 numbers are needed, not 2"),
    (
        {"groups": {"a": "root", "b": "root"}, "unknowns": {"x": {"guess": 1, "group": "b"}}, "constraints": [{"is": "x == 1", "group": "a"}]},
        "constraints[0]: group 'a' holds it, but what it mentions lies in 'b'",
    ),
    (
        {"groups": {"a": "root"}, "unknowns": {"x": {"guess": 1, "frame": "a"}}, "constraints": [{"is": "x == 1", "group": "a"}]},
        "constraints[0]: group 'a' holds it, but what it mentions lies in 'root'",
    ),
    ({"unknowns": X, "observed": ["y"]}, "observed: [0]: column 1: no unknown and no let is called 'y'"),
    ({"expected": {"status": "good"}}, "expected: status: no status is called 'good'"),
    ({"expected": {"values": {"y": 1}}}, "expected: values: 'y': no unknown is called 'y'"),
    ({"expected": {"degrees": 1.5}}, "expected: degrees: a whole number is needed, not 1.5"),
    ({"expected": {"conflicts": [["a"]]}}, "expected: conflicts: [0]: [0]: no constraint is called 'a'"),
]  # fmt: skip
# ruff: noqa: E501 (one mistake a line)


@pytest.mark.parametrize(("form", "message"), MISTAKES, ids=[message[:60] for _, message in MISTAKES])
def test_a_mistake_is_told_with_its_place(form: object, message: str) -> None:
    with pytest.raises(FormError) as told:
        load(form)
    assert str(told.value) == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1, column 1: this is not JSON: expecting value"),
        ('{"about": }', "line 1, column 11: this is not JSON: expecting value"),
        ('{"unknowns": {"x": NaN}}', "NaN is not a number"),
        ('{"unknowns": {"x": -Infinity}}', "-Infinity is not a number"),
        ('{"unknowns": {"x": 1, "y": 2, "x": 3}}', "'x' is there twice"),
        ("[" * 100_000, "nested too deeply"),
        (
            '{"unknowns": {"x": ' + "9" * 10_000 + "}}",
            "unknown 'x': guess: a number between -1e+150 and 1e+150 is needed",
        ),
        (
            json.dumps({"groups": {f"g{i}": f"g{i - 1}" if i else "root" for i in range(LEVELS + 1)}}),
            f"group 'g{LEVELS}': more than {LEVELS} levels deep",
        ),
    ],
    ids=lambda value: value[:20],
)
def test_a_mistake_of_the_text(text: str, message: str) -> None:
    with pytest.raises(FormError) as told:
        read(text)
    assert str(told.value) == message


# ---- hostile input -------------------------------------------------------------------------------------

FULL: dict[str, Any] = {
    "about": "every member there is",
    "groups": {"a": "root", "b": "a"},
    "unknowns": {
        "x": {"guess": 1, "scale": 2, "kept": True, "group": "a", "longest": 3},
        "f": {"guess": 1, "frame": "b"},
        "y": 2,
    },
    "let": {"sum": "x + y"},
    "constraints": [
        {
            "tag": "t", "let": {"d": "sum - f"}, "is": ["d == 3", "max(x, y) <= 9"], "placed": ["x"], "weight": 2,
            "scale": [1, 2],
        },
        {"tag": "u", "is": "x >= -1", "group": "a"},
    ],
    "observed": ["y", {"is": "x + f", "group": "a", "let": {"z": "f"}}],
    "expected": {
        "status": "solved", "values": {"y": 1}, "tolerance": 1, "degrees": 1, "conflicts": [["t"]],
        "changed": ["x"], "redundant": ["u"],
    },
}  # fmt: skip
_WORDS = [
    "",
    "x",
    "y",
    "t",
    "root",
    "a",
    "is",
    "guess",
    "group",
    "frame",
    "x == y",
    "f / (x - x) <= 0",
    "\ud800",
]
_SCALARS = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.sampled_from([10**400, 1e150, -1.0, *_WORDS])
    | st.text(max_size=8)
)
_JSON = st.recursive(
    _SCALARS,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from([*_WORDS, *FULL]) | st.text(max_size=4), inner, max_size=4)
    ),
    max_leaves=15,
)


def _places(value: object, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [place, *(deeper for key, part in parts for deeper in _places(part, (*place, key)))]


def _read_or_refuse(form: object) -> None:
    try:
        case = load(form)
    except FormError:
        return
    assert isinstance(case, Case)
    assert _structure(_again(case.problem)) == _structure(case.problem)


class TestHostileInput:
    @given(st.data())
    @tries(300)
    def test_anything_in_any_place(self, data: st.DataObject) -> None:
        form = copy.deepcopy(FULL)
        *place, last = data.draw(st.sampled_from(_places(FULL)[1:]))
        holder: Any = form
        for key in place:
            holder = holder[key]
        if data.draw(st.booleans()):
            holder[last] = data.draw(_JSON)
        else:
            del holder[last]
        _read_or_refuse(form)

    @given(_JSON)
    @tries(200)
    def test_anything(self, form: object) -> None:
        _read_or_refuse(form)

    @given(st.text(alphabet="xy.[]()+-*/%^=<>,0123456789e minhypot", max_size=30))
    @tries(300)
    def test_any_expression(self, text: str) -> None:
        _read_or_refuse({"unknowns": {"x": 1, "y": 2}, "constraints": [text, f"{text} == 0"]})

    @given(st.text(max_size=30) | st.text(alphabet='{}[]:,"0e', max_size=30))
    @tries(200)
    def test_any_text(self, text: str) -> None:
        with contextlib.suppress(FormError):
            read(text)

    def test_the_form_that_is_mangled_is_right(self) -> None:
        assert load(FULL).expected.redundant == {"u"}


# ---- the command ---------------------------------------------------------------------------------------

SOLVED = '{"unknowns": {"x": 0, "y": 1}, "constraints": [{"tag": "sum", "is": "x + y == 3"}]}'
WRONG = '{"unknowns": {"x": 0}, "constraints": ["x == 1", {"tag": "two", "is": "x == 2"}, "sqrt(-1) == 0"]}'


class TestCommand:
    @pytest.fixture
    def run(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Any:
        def run(content: str | bytes, *options: str) -> tuple[int, str, str]:
            path = tmp_path / "problem.json"
            path.write_bytes(content.encode() if isinstance(content, str) else content)
            code = main([str(path), *options])
            out, err = capsys.readouterr()
            return code, out, err.replace(str(path), "FILE")

        return run

    def test_solved(self, run: Any) -> None:
        assert run(SOLVED) == (
            0,
            "solved\ndegrees of freedom: 1\n  x = 1\n  y = 2\nsum: holds, residual 0\n",
            "",
        )

    def test_not_solved(self, run: Any) -> None:
        code, out, err = run(WRONG)
        assert (code, err) == (1, "")
        assert "two: does not hold, residual 1\n" in out
        assert "#2: does not hold, no value\n" in out
        assert "root failed, contradictory: no fewer than #0, two\n" in out

    def test_json(self, run: Any) -> None:
        code, out, _ = run(WRONG, "--json", "--stages")
        told = json.loads(out, parse_constant=pytest.fail)
        assert code == 1
        assert told["status"] == "partial"
        assert told["values"] == {"x": 1.0}
        assert told["constraints"][2] == {"tag": "#2", "holds": False, "residual": None}
        assert ["#0", "two"] in [failure["conflict"] for failure in told["failures"]]
        assert {stage["group"] for stage in told["stages"]} == {"root"}

    def test_sizes_and_what_is_redundant(self, run: Any) -> None:
        form = {
            "unknowns": {"r": {"guess": 1, "kept": True}, "x": 0},
            "constraints": ["r == 2", "x == 1", "2 * x == 2"],
        }
        _, out, _ = run(json.dumps(form))
        assert "sizes that changed: r\n" in out
        assert "redundant: #2\n" in out

    def test_stages_and_time(self, run: Any) -> None:
        _, out, _ = run(SOLVED, "--stages", "--repeat", "3")
        *_, stage, time = out.splitlines()
        assert stage == "root, own: succeeded with 2 unknowns and 1 rows"
        assert time.startswith("median time: ")
        assert float(time.split()[2]) > 0.0

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            ("[]", "FILE: an object is needed, not a list\n"),
            ('{"constraints": ["q == 1"]}', "FILE: constraints[0]: is: column 1: no unknown and no let is called 'q'\n"),
            (b'{"about": "\xff"}', "FILE: byte 11 is not UTF-8\n"),
        ],
    )  # fmt: skip
    def test_a_bad_file(self, run: Any, content: str | bytes, message: str) -> None:
        assert run(content) == (2, "", message)

    def test_no_file(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        assert main([str(tmp_path / "none.json")]) == 2
        assert capsys.readouterr().err == f"{tmp_path / 'none.json'}: No such file or directory\n"

    @pytest.mark.parametrize("times", ["0", "-1", "many"])
    def test_a_wrong_count(self, run: Any, times: str) -> None:
        with pytest.raises(SystemExit, match="2"):
            run(SOLVED, "--repeat", times)

    def test_the_page_shows_what_it_prints(self, run: Any) -> None:
        (form,) = (block.text for block in PAGE if block.language == "json")
        (shown,) = (block.text for block in PAGE if block.language == "console")
        code, out, _ = run(form)
        assert (code, out) == (0, shown.split("\n", 1)[1])
