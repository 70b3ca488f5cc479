"""The editor in the pane is what its sources make, as far as that can be told without Node."""

from __future__ import annotations

import hashlib
import re

from aidl_dev.highlighting.codemirror import words
from tests.documents import ROOT

PANE = ROOT / "server" / "aidl_server" / "preview" / "pane"
PROJECT = ROOT / "editors" / "codemirror"


def test_the_editor_is_made_of_the_present_sources() -> None:
    script = (PROJECT / "pane" / "build.mjs").read_text("utf-8")
    listed = re.search(r"const SOURCES = \[(.*?)\]", script, re.DOTALL)
    assert listed is not None
    sources = re.findall(r'"([^"]+)"', listed[1])
    digest = hashlib.sha256(b"".join((PROJECT / name).read_bytes() for name in sources)).hexdigest()
    first = (PANE / "editor.js").read_text("utf-8").partition("\n")[0]
    assert first.endswith(f"Of: {digest}"), "run `npm run pane` in editors/codemirror"
    made = {path.name for path in (PROJECT / "src").iterdir()} - {"parser.ts", "parser.terms.ts", "words.ts"}
    assert {f"src/{name}" for name in made} <= set(sources)


def test_the_words_of_the_editor_are_those_of_the_language() -> None:
    assert (PANE / "words.js").read_text("utf-8") == words(typed=False), "run `make colours`"
    assert 'from"./words.js"' in (PANE / "editor.js").read_text("utf-8")


def test_what_is_bundled_comes_with_its_licences() -> None:
    licences = (PANE / "editor.LICENSES.txt").read_text("utf-8")
    for name in ("@codemirror/view", "@codemirror/state", "@lezer/lr", "style-mod"):
        assert f"\n{name}\n" in licences
    assert licences.count("Permission is hereby granted") > 10


def test_the_pane_loads_nothing_from_elsewhere() -> None:
    addresses = re.findall(r"https?://[\w./-]+", (PANE / "editor.js").read_text("utf-8"))
    assert set(addresses) <= {"http://www.w3.org/2000/svg"}
