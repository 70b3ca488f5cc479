"""The tree-sitter grammar, compiled by the C compiler at hand, and what its trees say of a text."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from tree_sitter import Language, Node, Parser, Tree

from aidl_lang.common.names import fold
from aidl_lang.syntax.tables import kind_of, load_tables
from aidl_lang.tools.vocabulary import vocabulary
from tests.documents import ROOT

FOLDER = ROOT / "editors" / "tree-sitter-aidl"
COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")

SLIPS = ("unknown_unit", "ellipsis")
"""Nodes that hold what is wrong in a place where the rest can be read."""


@cache
def language() -> Language:
    if COMPILER is None:
        pytest.skip("there is no C compiler")
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "aidl.so"
        source = FOLDER / "src"
        command = [COMPILER, "-shared", "-fPIC", "-Wall", "-Werror", f"-I{source}", str(source / "parser.c")]
        subprocess.run([*command, "-o", str(library)], check=True)
        function = ctypes.CDLL(str(library)).tree_sitter_aidl
    function.restype = ctypes.c_void_p
    capsule = ctypes.pythonapi.PyCapsule_New
    capsule.restype, capsule.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return Language(capsule(function(), b"tree_sitter.Language", None))


def parse(text: str) -> Tree:
    return Parser(language()).parse(text.encode())


def nodes(tree: Tree) -> Iterator[Node]:
    """All nodes, in the order of the text."""
    stack = [tree.root_node]
    while stack:
        node = stack.pop()
        yield node
        stack += node.children[::-1]


def leaves(found: list[Node]) -> list[Node]:
    return [node for node in found if not node.child_count]


def refused(tree: Tree) -> str | None:
    """Why the text is no program, or None if it is one."""
    if tree.root_node.has_error:
        return "error"
    found = list(nodes(tree))
    for node in found:
        if node.type in SLIPS:
            return node.type
        if node.type == "structure" and kind_of(_text(node.child_by_field_name("kind"))) is None:
            return "kind"
        if node.type == "attribute" and _is_out_of_place(node):
            return "attribute"
    for name, after in pairwise(leaves(found)):
        if (
            name.type == "identifier"
            and after.type == "("
            and re.fullmatch("[ \t]+", _gap(name, after, tree))
        ):
            return "blank before the parenthesis of a call"
    return None


def beyond(tree: Tree) -> str | None:
    """What keeps the tree from telling whether the text is a program: all of it of tokens that touch."""
    found = list(nodes(tree))
    for node, after in pairwise(leaves(found)):
        touch = node.end_byte == after.start_byte
        if node.type.endswith("_comment") and touch and _is_second_half(after):
            return "a comment between two tokens that touch elsewhere"
        if touch and node.type == "then" and after.type == "(":
            return "`then(` is a call"
        if touch and after.type == "(" and _ends_statement(node):
            return "a call in the place of a name"
    for node in found:
        if node.type == "unknown_unit" and _is_word(_text(node)):
            return "a word that touches a number"
    return None


def _is_word(text: str) -> bool:
    """Whether it is a word of the grammar, with a unit before it or not."""
    words = load_tables().reserved | load_tables().soft_words
    return any(
        text.removeprefix(unit) in words for unit in ("", *vocabulary().units) if text.startswith(unit)
    )


def _is_second_half(node: Node) -> bool:
    inside = node.parent.type if node.parent else ""
    return node.type in ("unit", "unknown_unit") or (
        inside in ("arguments", "parameters", "string") and node.type in ("(", '"', "'", "string_content")
    )


def _ends_statement(node: Node) -> bool:
    statement = node.parent
    if node.type != "identifier" or statement is None:
        return False
    return node in (
        *(statement.children_by_field_name("target") if statement.type == "alias_declaration" else ()),
        *(statement.children_by_field_name("alias") if statement.type == "import_statement" else ()),
    )


def _gap(before: Node, after: Node, tree: Tree) -> str:
    whole = tree.root_node.text or b""
    start = tree.root_node.start_byte
    return whole[before.end_byte - start : after.start_byte - start].decode()


def _text(node: Node | None) -> str:
    return (node.text or b"").decode() if node else ""


def _is_out_of_place(attribute: Node) -> bool:
    """Whether another attribute than `@allow` stands before another statement than those that take it."""
    holder = attribute.parent
    taken = holder is not None and holder.type in ("structure", "assignment")
    return not taken and fold(_text(attribute.child_by_field_name("name"))) != "allow"
