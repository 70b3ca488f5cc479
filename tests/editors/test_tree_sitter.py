"""The tree-sitter grammar takes what the parser takes, refuses what it refuses, and finds the same spans."""

from __future__ import annotations

import ast as python
import json
import os
import random
import re
import shutil
import subprocess
import unicodedata
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from tree_sitter import Node

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse as read
from aidl_lang.syntax import ast
from aidl_lang.syntax.rewriting import begins_with_sign
from aidl_lang.syntax.tables import load_tables, tokenize
from aidl_lang.tools.vocabulary import vocabulary
from tests.amount import TRIES_ALL, large, some
from tests.documents import ROOT, programs
from tests.editors.trees import FOLDER, beyond, nodes, parse, refused
from tests.fuzz.sources import mutant
from tests.property.test_hostile import HOSTILE

NOT_OF_SYNTAX = frozenset(["E0125", "E0801", "E0802", "E0803"])
"""Errors of the parser that no grammar tells: of lines, and of what is too much."""


@cache
def errors(text: str) -> list[str]:
    """The codes of the parser's errors that are of the syntax."""
    found = {d.code for d in read(SourceFile("", text)).diagnostics if d.is_error}
    return sorted(found - NOT_OF_SYNTAX)


# --- The corpus -----------------------------------------------------------------------------------


@cache
def whole_programs() -> dict[str, str]:
    """What the project itself has written as programs that are read."""
    folders = ("examples", "stdlib", "eval/aidl_eval/prompts")
    files = [path for folder in folders for path in sorted((ROOT / folder).rglob("*.aidl"))]
    return {str(path.relative_to(ROOT)): path.read_text("utf-8") for path in files}


_LIST_BEGINS_A_LINE = re.compile(r"^ *\[\w[\w., ]*\]\.", re.MULTILINE)
"""The parser alone knows lines: among constraints it takes a list that begins one as a statement."""


@cache
def specified() -> dict[str, str]:
    """Of the programs of `tests/spec`, those that are read."""
    pages = sorted((ROOT / "tests/spec").glob("*.md"))
    found = some([block for page in pages for block in programs(page)], 9)
    return {
        block.place: block.text
        for block in found
        if not errors(block.text) and not _LIST_BEGINS_A_LINE.search(block.text)
    }


@cache
def all_programs() -> dict[str, str]:
    """These, those of the documentation and of the tests, good and bad, by their places."""
    found = dict(whole_programs())
    ours = (path for path in (ROOT / "tests").rglob("*.aidl") if "fuzz" not in path.parts)  # which are noise
    for path in sorted(ours):
        found[str(path.relative_to(ROOT))] = path.read_text("utf-8")
    for page in [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md")), *sorted(ROOT.glob("tests/**/*.md"))]:
        found |= {block.place: block.text for block in programs(page)}
    found = {place: text for place, text in found.items() if not _LIST_BEGINS_A_LINE.search(text)}
    found |= {f"hostile {name}": text for name, text in HOSTILE.items()}
    for path in [
        *sorted((ROOT / "tests/parser").glob("*.py")),
        *sorted((ROOT / "tests/printer").glob("*.py")),
    ]:
        found |= {f"{path.name}:{n} {text[:20]!r}": text for n, text in _texts(path)}
    return found


def _texts(path: Path) -> Iterator[tuple[int, str]]:
    """The texts in a module of tests: mostly programs, many of them broken."""
    for node in python.walk(python.parse(path.read_text("utf-8"))):
        if isinstance(node, python.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_every_program_of_the_project_is_read_without_an_error() -> None:
    assert len(whole_programs()) > 50
    bad = {
        place: [(n.type, n.start_point) for n in nodes(tree) if n.is_error or n.is_missing]
        for place, text in whole_programs().items()
        if (tree := parse(text)).root_node.has_error or refused(tree)
    }
    assert bad == {}


def test_every_program_is_taken_or_refused_as_by_the_parser() -> None:
    assert len(all_programs()) > 1500
    programs = some(sorted(all_programs().items()), 7)
    verdicts = {place: (refused(parse(text)), errors(text)) for place, text in programs}
    different = {place: said for place, said in verdicts.items() if bool(said[0]) != bool(said[1])}
    assert different == {}
    assert sum(1 for reason, _ in verdicts.values() if reason) > 30


# --- Mutants --------------------------------------------------------------------------------------


def mutants(count: int) -> Iterator[str]:
    rng = random.Random(2)
    texts = sorted(text for text in whole_programs().values() if len(text) < 3000)
    texts += specified().values()
    for _ in range(count):
        yield mutant(rng, texts)


def test_mutants_are_taken_or_refused_as_by_the_parser() -> None:
    verdicts = Counter[str]()
    different = []
    count = large(1000)
    for text in mutants(count):
        tree, codes = parse(text), errors(text)
        if bool(refused(tree)) == bool(codes):
            verdicts["refused" if codes else "taken"] += 1
        elif reason := beyond(tree):
            verdicts[reason] += 1
        else:
            different.append((refused(tree), codes, text))
    assert different == []
    assert verdicts["taken"] > count / 8
    assert verdicts["refused"] > count / 2
    assert sum(verdicts.values()) - verdicts["taken"] - verdicts["refused"] <= 3, verdicts


def has_signed_lines(text: str) -> bool:
    """Whether a constraint begins with a sign on a line of its own, which the parser alone tells."""
    tokens = tokenize(SourceFile("", text)).tokens
    return any(begins_with_sign(text, tokens, place) for place in range(len(tokens)))


def test_the_letters_of_names_are_those_of_the_parser() -> None:
    """All that this Python's version of Unicode has."""
    pattern = re.compile(load_tables().patterns["NAME"])
    letters = [
        char
        for char in map(chr, range(0x80, 0x110000))
        if unicodedata.category(char) not in ("Cn", "Co", "Cs") and char != "\ufeff"
    ]
    for before in ("", "x"):
        good = [char for char in letters if pattern.fullmatch(before + char)]
        assert len(good) > 100_000
        assert not parse(f"let all = [{', '.join(before + char for char in good)}]").root_node.has_error
        bad = set(letters).difference(good)
        assert len(bad) > 5_000
        assert [
            char for char in some(sorted(bad), 36) if not parse(f"let {before}{char} = 1").root_node.has_error
        ] == []


# --- Words ----------------------------------------------------------------------------------------


def test_words_and_signs_are_those_of_the_language() -> None:
    grammar = json.loads((FOLDER / "src/grammar.json").read_text("utf-8"))
    reserved = {member["value"] for member in grammar["reserved"]["global"]}
    assert reserved == load_tables().reserved
    units = set(_strings(grammar["rules"].pop("unit")))
    assert units == set(vocabulary().units)
    quotes_and_slips = {'"', "'", "..."}
    assert set(_strings(grammar["rules"])) - quotes_and_slips == set(vocabulary().signs) | set(
        vocabulary().keywords
    )


def _strings(rule: object) -> Iterator[str]:
    """The fixed texts in a rule of `grammar.json`."""
    if isinstance(rule, dict):
        if rule.get("type") == "STRING":
            yield rule["value"]
        if rule.get("type") != "ALIAS" or rule["named"]:
            rule = list(rule.values())
        else:
            rule = [rule["content"]]
    if isinstance(rule, list):
        for member in rule:
            yield from _strings(member)


# --- Spans ----------------------------------------------------------------------------------------

NODES: dict[type[ast.Node], str] = {
    ast.Structure: "structure",
    ast.Assign: "assignment",
    ast.Param: "param_declaration",
    ast.Var: "var_declaration",
    ast.Let: "let_declaration",
    ast.FunctionDefinition: "function_definition",
    ast.ShapeDefinition: "shape_definition",
    ast.ConstraintDefinition: "constraint_definition",
    ast.Alias: "alias_declaration",
    ast.Import: "import_statement",
    ast.Prefer: "prefer_statement",
    ast.Assert: "assert_statement",
    ast.Equation: "equation",
    ast.If: "if_statement",
    ast.IfArguments: "if_arguments",
    ast.Parameter: "parameter",
    ast.Attribute: "attribute",
    ast.Placement: "placement",
    ast.Call: "call_expression",
    ast.Member: "member_expression",
    ast.Comparison: "comparison_expression",
    ast.Conditional: "conditional_expression",
    ast.Range: "range_expression",
    ast.Point: "point",
    ast.Number: "number",
    ast.String: "string",
}


def test_spans_are_those_of_the_parser() -> None:
    seen = Counter[str]()
    for place, text in [*some([*whole_programs().items()], 8), *specified().items()]:
        if has_signed_lines(text):
            continue
        ends = [0]
        for char in text:
            ends.append(ends[-1] + len(char.encode()))
        mine = Counter(_spans(read(SourceFile(place, text)).module, ends))
        wanted = set(NODES.values())
        theirs = Counter(
            (n.type, n.start_byte, n.end_byte)
            for n in nodes(parse(text))
            if n.type in wanted and not is_method(n)
        )
        assert mine == theirs, place
        seen.update(kind for kind, _, _ in mine)
    assert set(seen) <= set(NODES.values())
    assert len(seen) >= len(set(NODES.values())) - (0 if TRIES_ALL else 2)
    assert seen["structure"] > 60
    assert seen["param_declaration"] > 20


def is_method(node: Node) -> bool:
    """Whether it is the `a.b` of `a.b()`, which is no value of its own."""
    call = node.parent
    return (
        call is not None and call.type == "call_expression" and call.child_by_field_name("function") == node
    )


def _spans(module: ast.Module, ends: list[int]) -> Iterator[tuple[str, int, int]]:
    stack: list[ast.Node] = [module]
    while stack:
        node = stack.pop()
        stack += [*ast.children(node), *(node.allowing if isinstance(node, ast.Allowing) else ())]
        if kind := NODES.get(type(node)):
            yield kind, ends[node.span.start], ends[node.span.end]


# --- The grammar's own tests ----------------------------------------------------------------------

_CASE = re.compile(
    r"^={20,}\n(?P<name>[^\n]+)\n(?P<error>:error\n)?={20,}\n(?P<text>.*?)^-{20,}\n(?P<tree>.*?)(?=^={20,}\n|\Z)",
    re.MULTILINE | re.DOTALL,
)


def _cases() -> list[object]:
    found = []
    for path in sorted((FOLDER / "test/corpus").glob("*.txt")):
        text = path.read_bytes().decode()
        cases = list(_CASE.finditer(text))
        assert "".join(case[0] for case in cases) == text, path.name
        found += [pytest.param(case, id=f"{path.stem}: {case['name']}") for case in cases]
    assert len(found) > 40
    return found


@pytest.mark.parametrize("case", _cases())
def test_corpus(case: re.Match[str]) -> None:
    tree = parse(case["text"].removesuffix("\n"))
    if case["error"]:
        assert tree.root_node.has_error
    else:
        assert str(tree.root_node) == " ".join(case["tree"].split()).replace(" )", ")")
        assert not tree.root_node.has_error
    if not beyond(tree):
        assert bool(refused(tree)) == bool(errors(case["text"]))


def test_every_kind_of_node_has_a_case() -> None:
    """All nodes with names, but for those that only group others."""
    kinds = json.loads((FOLDER / "src/node-types.json").read_text("utf-8"))
    named = {kind["type"] for kind in kinds if kind["named"] and "subtypes" not in kind}
    cases = "".join(path.read_text("utf-8") for path in (FOLDER / "test/corpus").glob("*.txt"))
    assert {name for name in named if f"({name}" not in cases} == set()


# --- What an editor does --------------------------------------------------------------------------


def test_a_program_being_written_keeps_the_statements_that_are_complete() -> None:
    text = (ROOT / "examples/telephone.aidl").read_text("utf-8")
    params = [n for n in nodes(parse(text)) if n.type == "param_declaration"]
    for end in range(0, len(text), 97):
        kept = {n.text for n in nodes(parse(text[:end])) if n.type == "param_declaration"}
        assert {n.text for n in params if n.end_byte < end} <= kept


# --- The generated parser -------------------------------------------------------------------------

GENERATOR = os.environ.get("TREE_SITTER") or shutil.which("tree-sitter")
VERSION = "tree-sitter 0.27"


@pytest.mark.skipif(GENERATOR is None, reason="tree-sitter is neither on PATH nor named by TREE_SITTER")
def test_the_parser_is_made_of_the_grammar(tmp_path: Path) -> None:
    assert GENERATOR is not None
    version = subprocess.run([GENERATOR, "--version"], check=True, capture_output=True, text=True).stdout
    if not version.startswith(VERSION):
        pytest.skip(f"the parser was made by {VERSION}, not {version.strip()}")
    subprocess.run([GENERATOR, "generate", "--output", str(tmp_path)], check=True, cwd=FOLDER)
    committed = {p.relative_to(FOLDER / "src"): p for p in (FOLDER / "src").rglob("*") if p.is_file()}
    made = {p.relative_to(tmp_path): p for p in tmp_path.rglob("*") if p.is_file()}
    assert set(made) == set(committed)
    different = [name for name in made if made[name].read_bytes() != committed[name].read_bytes()]
    assert different == [], "run `tree-sitter generate` in editors/tree-sitter-aidl"
