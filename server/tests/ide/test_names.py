"""Definitions, references and renaming, also across files."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast
from aidl_server.ide.references import (
    CannotError,
    definitions,
    highlights,
    mention_at,
    mentions,
    place_of,
    references,
    rename,
    renameable,
)
from aidl_server.ide.workspace import Project, View, applied
from server.tests.ide.conftest import opened
from tests.compiled import FEW

FOLDER = Path("/project")

HOLES = """\
/// A hole for a bolt.
param clearance = 0.4mm in 0.1..1
hole bolt(size = 4, depth_mark = 0) {
    rim = circle(center: (0, 0), radius: (size + clearance) / 2)
}
fn spaced(n, pitch = 10) = n * pitch
"""
PLATE = """\
import "holes.aidl" as holes
solid plate {
    param width = 60mm in 40..90
    body = rectangle(center: origin, width: width, height: 20 + holes.clearance)
    a = holes.bolt(size: 5)
    constrain {
        a.rim.center == body.center
        body.width >= holes.spaced(n: 2)
    }
}
"""
PAIR = """\
import clearance, bolt from "holes.aidl"
import "plate.aidl"
solid strip {
    body = rectangle(center: origin, width: 30, height: 10 + Clearance)
    b = bolt(size: 3)
    constrain b.rim.center == body.center
}
"""
FILES = {"holes.aidl": HOLES, "plate.aidl": PLATE, "pair.aidl": PAIR}


def view_in(project: Project, name: str) -> View:
    view = project.view(FOLDER / name)
    assert view is not None
    return view


def at(view: View, before: str, name: str) -> int:
    """The offset of a name in the first line that has `before` in it."""
    return view.source.text.index(name, view.source.text.index(before))


def places(project: Project, name: str, before: str, word: str) -> list[tuple[str, int, str]]:
    view = view_in(project, name)
    found = references(project, view, at(view, before, word))
    return [(o.path.name, o.span.line, o.span.text) for o in found]


def test_a_param_is_found_in_three_files_however_it_is_spelled() -> None:
    expected = [
        ("holes.aidl", 2, "clearance"),
        ("holes.aidl", 4, "clearance"),
        ("pair.aidl", 1, "clearance"),
        ("pair.aidl", 4, "Clearance"),
        ("plate.aidl", 4, "clearance"),
    ]
    project = opened(FILES)
    for name, before, word in (
        ("holes.aidl", "param", "clearance"),
        ("plate.aidl", "body =", "clearance"),
        ("pair.aidl", "body =", "Clearance"),
        ("pair.aidl", "import", "clearance"),
    ):
        assert places(project, name, before, word) == expected


def test_callables_parameters_and_members_are_found_across_files() -> None:
    project = opened(FILES)
    assert places(project, "holes.aidl", "hole bolt", "bolt") == [
        ("holes.aidl", 3, "bolt"),
        ("pair.aidl", 1, "bolt"),
        ("pair.aidl", 5, "bolt"),
        ("plate.aidl", 5, "bolt"),
    ]
    assert places(project, "pair.aidl", "bolt(size", "size") == [
        ("holes.aidl", 3, "size"),
        ("holes.aidl", 4, "size"),
        ("pair.aidl", 5, "size"),
        ("plate.aidl", 5, "size"),
    ]
    assert places(project, "plate.aidl", "a.rim", "rim") == [
        ("holes.aidl", 4, "rim"),
        ("pair.aidl", 6, "rim"),
        ("plate.aidl", 7, "rim"),
    ]


def test_renaming_a_param_of_three_files_changes_those_places_and_no_picture() -> None:
    project = opened(FILES)
    view = view_in(project, "plate.aidl")
    renaming = rename(project, view, at(view, "body =", "clearance"), "play")
    changed = FILES | {path.name: applied(FILES[path.name], edits) for path, edits in renaming.items()}
    assert changed == {
        "holes.aidl": HOLES.replace("clearance", "play"),
        "plate.aidl": PLATE.replace("clearance", "play"),
        "pair.aidl": PAIR.replace("clearance", "play").replace("Clearance", "play"),
    }
    after = opened(changed)
    for name in ("plate.aidl", "pair.aidl"):
        pictures = []
        for files in (project, after):
            text = files.workspace.text(FOLDER / name)
            compiled = pipeline.compile(SourceFile(name, text), files.workspace.world(FOLDER / name))
            assert compiled.ok
            pictures.append(compiled.export(".svg"))
        assert pictures[0] == pictures[1]


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("2x", "is no name"),
        ("a b", "is no name"),
        ("", "is no name"),
        ("a(", "is no name"),
        ("for", "is a word of the language"),
        ("size", "would mean something else"),
    ],
)
def test_a_name_that_would_change_a_meaning_is_refused(name: str, reason: str) -> None:
    project = opened(FILES)
    view = view_in(project, "holes.aidl")
    with pytest.raises(CannotError, match=reason):
        rename(project, view, at(view, "param", "clearance"), name)


def test_a_name_that_an_importing_file_uses_otherwise_is_refused() -> None:
    project = opened(FILES | {"pair.aidl": PAIR.replace("solid strip {", "let play = 3\nsolid strip {")})
    view = view_in(project, "holes.aidl")
    with pytest.raises(CannotError, match=r"pair\.aidl"):
        rename(project, view, at(view, "param", "clearance"), "play")


@pytest.mark.parametrize(
    ("before", "word", "reason"),
    [
        ("rectangle", "rectangle", "standard library"),
        ("origin", "origin", "built in"),
        ("60mm", "60", "no name"),
    ],
)
def test_what_is_not_the_authors_has_no_other_name(before: str, word: str, reason: str) -> None:
    view = view_in(opened(FILES), "plate.aidl")
    with pytest.raises(CannotError, match=reason):
        renameable(view, at(view, before, word))


def test_definitions_lead_into_other_files_and_the_library() -> None:
    project = opened(FILES)
    view = view_in(project, "plate.aidl")

    def definition(before: str, word: str) -> tuple[str, int]:
        (span,) = definitions(view, at(view, before, word))
        file = view.file(span.source)
        assert file is not None
        assert file.exists() or file.parent == FOLDER
        return file.name, span.line

    assert definition("width: width", "width,") == ("plate.aidl", 3)
    assert definition("holes.bolt", "bolt") == ("holes.aidl", 3)
    assert definition("holes.bolt", "size") == ("holes.aidl", 3)
    assert definition("holes.spaced", "n:") == ("holes.aidl", 6)
    assert definition("import", '"holes') == ("holes.aidl", 1)
    assert definition("rectangle", "rectangle")[0] == "rectangles.aidl"
    assert definition("rectangle", "height")[0] == "rectangles.aidl"
    assert definitions(view, at(view, "60mm", "60")) == []


def test_an_alias_is_a_name_of_its_own() -> None:
    text = "alias board = rectangle\nsolid s { r = board(center: origin, width: 3, height: 4) }\n"
    project = opened({"part.aidl": text})
    view = view_in(project, "part.aidl")
    renaming = rename(project, view, text.index("board("), "sheet")
    assert [e.span.start for e in renaming[FOLDER / "part.aidl"]] == [6, text.index("board(")]
    (target,) = definitions(view, text.index("rectangle"))
    assert view.is_library(target.source)


def test_both_branches_of_an_if_declare_one_thing() -> None:
    text = """\
param big = true
solid s {
    if big { c = circle(center: origin, radius: 9) } else { c = circle(center: origin, radius: 4) }
    constrain c.radius >= 1
}
"""
    project = opened({"part.aidl": text})
    view = view_in(project, "part.aidl")
    (edits,) = rename(project, view, text.index("c.radius"), "disk").values()
    assert len(edits) == 3


WORDS = {"x", "y", "left", "right", "center", "top", "bottom", "round", "ball", "slope", "fade", "none"}
"""Words of arguments and attributes in the examples, which name nothing."""


def test_every_name_of_the_examples_has_a_meaning_and_leads_back(example: View) -> None:
    known = list(mentions(example))
    for node in ast.walk(example.module):
        if isinstance(node, ast.Name) and node not in example.resolution.uses:
            assert node.text in WORDS, node.text
    for mention in known:
        found = mention_at(example, mention.span.start)
        assert found is not None
        assert found.span == mention.span
        assert found.symbol is mention.symbol or place_of(example, found.symbol) == place_of(
            example, mention.symbol
        )
        own = [d for d in mention.symbol.declarations if d.span.source is example.source]
        if own:
            spans = [o.span for o in highlights(example, mention.span.start)]
            assert mention.span in spans
            assert own[0].span in spans


@pytest.mark.parametrize("path", FEW)
def test_each_param_of_an_example_can_be_renamed(path: Path) -> None:
    project = opened({path.name: path.read_text("utf-8")}, path.parent)
    view = project.view(path)
    assert view is not None
    params = [node for node in ast.walk(view.module) if isinstance(node, ast.Param)]
    for param in params[:2]:
        renaming = rename(project, view, param.name.span.start, "another_name")
        assert set(renaming) == {path}
        assert {edit.span.text for edit in renaming[path]} == {param.name.text}
        text = applied(view.source.text, renaming[path])
        before = pipeline.check(view.source, view.world)
        after = pipeline.check(SourceFile(path.name, text), view.world)
        assert [d.code for d in before] == [d.code for d in after]


def test_a_view_is_made_anew_when_what_it_imports_changes() -> None:
    project = opened(FILES)
    first = view_in(project, "plate.aidl")
    assert view_in(project, "plate.aidl") is first
    project.workspace.open[FOLDER / "holes.aidl"] = HOLES.replace("0.4mm", "0.5mm")
    second = view_in(project, "plate.aidl")
    assert second is not first
    del project.workspace.open[FOLDER / "holes.aidl"]
    third = view_in(project, "plate.aidl")
    assert any(d.code == "E0210" for d in third.found)
    project.workspace.open[FOLDER / "holes.aidl"] = HOLES
    assert not any(d.is_error for d in view_in(project, "plate.aidl").found)
