"""The reference: every example runs, is drawn as committed and states what holds; what is read off
definitions is right.

What a new name needs besides, and what is generated, is told by `test_public_names`.
"""

from __future__ import annotations

import re

import pytest

from aidl_dev.reference.guide import template
from aidl_dev.reference.pages import image
from aidl_dev.reference.site import texts
from aidl_lang.checking import builtins, library
from aidl_lang.common.diagnostics import Severity
from aidl_lang.common.render import render
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import KINDS, load_tables
from aidl_lang.tools.reference import full_guide, guide
from aidl_lang.tools.reference.collect import Entry, reference
from aidl_lang.tools.reference.signatures import split_items
from tests.checker.checking import check
from tests.compiled import EXAMPLES, json_of
from tests.compiled import compiled as compiled_of
from tests.documents import ROOT

ENTRIES = list(reference().entries.values())

NOT_WORDS = frozenset({"comprehension"})
"""Sections on the language that are not headed by a word of it, a kind or an attribute."""


# --- Every public name is documented --------------------------------------------------------------


@pytest.mark.parametrize("entry", [pytest.param(e, id=e.name) for e in ENTRIES if e.doc.example])
def test_example_runs_and_is_drawn_as_committed(entry: Entry) -> None:
    compiled = compiled_of(entry.doc.example)
    found = [d for d in compiled.diagnostics if d.severity is not Severity.NOTE]
    assert compiled.ok, f"{entry.where}: {compiled.status}\n" + "\n".join(map(render, found))
    assert not found, f"{entry.where}\n" + "\n".join(map(render, found))
    committed = ROOT / "docs" / "reference" / image(entry)
    assert committed.is_file(), "run `make reference`"
    assert compiled.export(".svg") == committed.read_bytes(), "run `make reference`"
    if entry.sort in ("constraint", "relation"):
        judged = check(entry.doc.example, json_of(entry.doc.example))
        assert any(f.kind == "constraint" for f in judged)
        assert [str(f) for f in judged if not f.holds] == [], f"{entry.where}, judged from outside"


def test_examples_use_what_they_are_about() -> None:
    """By its name or a synonym; the example of a relation may stand in another's shoes no further."""
    for entry in (e for e in ENTRIES if e.sort != "word"):
        names = "|".join(map(re.escape, (entry.name, *entry.synonyms)))
        assert re.search(rf"\b({names})\b", entry.doc.example), f"{entry.where}: it shows something else"


def test_headings_of_builtins_are_their_signatures() -> None:
    """The same parameters, and the same ones may be left out; defaults are told by the headings alone."""
    for entry in (e for e in ENTRIES if e.sort == "builtin"):
        names = (entry.name, *(name for name in entry.synonyms if name in builtins.SIGNATURES))
        declared = {(name, _declared(s)) for name in names for s in builtins.SIGNATURES[name] if s.parameters}
        headed = {(o.form.partition("(")[0], _headed(o.form)) for o in entry.overloads if o.node is None}
        assert headed == declared or not declared, entry.name


def _declared(signature: builtins.Signature) -> tuple[tuple[str, bool], ...]:
    return tuple((name, optional) for name, _, optional in signature.parameters)


def _headed(form: str) -> tuple[tuple[str, bool], ...]:
    items = split_items(form.partition("(")[2].removesuffix(")"))
    return tuple((re.split(r"\W", item)[0], "=" in item or "?" in item) for item in items)


def test_sections_on_the_language_are_of_words_that_exist() -> None:
    tables = load_tables()
    words = {*tables.reserved, *tables.soft_words, *KINDS, *builtins.EVERYWHERE, *NOT_WORDS}
    words |= {f"@{name}" for name in builtins.ATTRIBUTES}
    assert [e.name for e in ENTRIES if e.sort == "word" and e.name not in words] == []


def test_words_of_the_language_have_sections() -> None:
    told = {e.name for e in ENTRIES if e.sort == "word"}
    attributes = {f"@{name}" for name in builtins.ATTRIBUTES if name != "colour"}
    assert {*load_tables().reserved, *KINDS, *builtins.EVERYWHERE, *attributes} - told == set()


def test_synonyms_lead_to_something() -> None:
    known = library.load()
    callable_ = known.callables.keys() | builtins.SIGNATURES.keys() | known.aliases.keys()
    assert sorted(alias for alias, target in known.aliases.items() if target not in callable_) == []


def test_examples_and_the_guide_use_public_names_only() -> None:
    texts = [path.read_text("utf-8") for path in EXAMPLES]
    texts += re.findall(r"```aidl\n(.*?)```", guide(), flags=re.DOTALL)
    assert set().union(*map(_private_names, texts)) == set()


def _private_names(text: str) -> set[str]:
    """Names of the library that a program calls without their being public."""
    module = parse(SourceFile("program", text)).module
    called = {n.callee.text for n in ast.walk(module) if isinstance(n, ast.Call)}
    known = library.load()
    return {name for name in called & known.callables.keys() if name not in reference().entries}


# --- What is read off definitions -----------------------------------------------------------------


def test_other_spellings_and_synonyms_are_found() -> None:
    known = reference()
    for name in ("rounded_rectangle", "RoundedRectangle", "rounded_rect", "`rounded_rectangle`"):
        assert known.find(name) is known.entries["rounded_rectangle"]
    assert known.find("color") is known.entries["@color"]
    assert known.find("no such thing") is None
    assert known.misspelt("perpendiculr") is known.entries["perpendicular"]


def test_the_patterns_of_the_library_are_those_that_derive() -> None:
    assert {entry.name for entry in reference().of_topic("patterns")} == builtins.FILLINGS


# --- What is generated ----------------------------------------------------------------------------


def test_links_in_generated_texts_lead_somewhere() -> None:
    for path, text in texts(ROOT).items():
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
            assert (ROOT / path).parent.joinpath(target).is_file(), f"{path}: {target}"


# --- The guide ------------------------------------------------------------------------------------


def test_guide_names_everything_that_can_be_called() -> None:
    words = set(re.findall(r"@?\w+", guide()))
    assert sorted(e.name for e in ENTRIES if e.sort != "word" and e.name not in words) == []


def test_guide_names_nothing_that_does_not_exist() -> None:
    """Every call in its prose, its templates' own placeholders and the programs' own definitions aside."""
    known = {*reference().entries, *reference().aliases, *builtins.ATTRIBUTES}
    prose = re.sub(r"```aidl.*?```", "", template(), flags=re.DOTALL)
    called = set(re.findall(r"\b([a-z_]\w*)\(", prose))
    assert called - known - {"f"} == set()


def test_full_guide_holds_every_entry() -> None:
    headings = set(re.findall(r"^### (.+)$", full_guide(), flags=re.MULTILINE))
    assert headings >= {e.name for e in ENTRIES}
    assert full_guide().startswith(guide().strip())


def test_codes_in_the_guide_exist() -> None:
    from aidl_lang.common import resources

    codes = set(re.findall(r"\b[EWN]\d{4}\b", guide()))
    assert codes
    assert codes <= set(resources.codes())
