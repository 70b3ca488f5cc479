"""The package as Python sees it, and its page in the documentation."""

from __future__ import annotations

import ast
import contextlib
import html
import io
import os
import pickle
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import aidl_lang
from aidl_lang.export import FORMATS
from aidl_lang.tools.cli import main
from tests.compiled import FEW, example
from tests.documents import ROOT, Block, blocks

PAGE = ROOT / "docs" / "python.md"
PLATE = "solid plate { param width = 80 in 20..200 step 5\n outline = rectangle(width: width, height: 50) }"
WRONG = "solid plate { outline = rectangle(widht: 80, height: 50) }"
FALSE = "solid disc { rim = circle(radius: 3)\n constrain rim.radius == 4\n constrain rim.radius == 5 }"


# --- The page --------------------------------------------------------------------------------------


def _run(text: str, names: dict[str, Any]) -> tuple[str, Any]:
    """Returns what a block prints, and the value it ends in as a cell of a notebook does."""
    tree = ast.parse(text)
    last = tree.body[-1]
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        if not isinstance(last, ast.Expr):
            exec(compile(tree, "<page>", "exec"), names)
            return printed.getvalue(), None
        exec(compile(ast.Module(tree.body[:-1], []), "<page>", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "<page>", "eval"), names)
    return printed.getvalue(), value


def test_the_page_on_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each block is run after those before it, and shows what stands below it."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    drawn: list[str] = []
    written = [*blocks(PAGE), Block(PAGE, 0, "", "end", "", "")]
    assert sum(block.language == "python" for block in written) > 8
    for block, following in pairwise(written):
        if block.language != "python":
            continue
        shown, value = _run(block.text, names)
        if isinstance(value, aidl_lang.Model):
            shown += _told(value)
            drawn += filter(None, [value._repr_svg_()])
        expected = following.text if following.language == "text" else ""
        assert shown == expected, f"{block.place} shows\n{shown}"
    picture = ROOT / "docs" / "images" / "notebook.svg"
    if os.environ.get("AIDL_ACCEPT") == "1":
        picture.write_text(drawn[0], "utf-8")
    assert drawn == [picture.read_text("utf-8")], "look at it, and run this with AIDL_ACCEPT=1"


def _told(model: aidl_lang.Model) -> str:
    """What a notebook tells below the drawing of a model, as text."""
    found = re.search("<pre>(.*)</pre>", model._repr_html_() or "", re.DOTALL)
    return html.unescape(found[1]) + "\n" if found else ""


def test_the_block_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (block,) = (b for b in blocks(ROOT / "README.md") if b.language == "python" and "aidl_lang" in b.text)
    printed, _ = _run(block.text, {})
    assert printed.startswith("4000.0")
    assert Path("plate.svg").exists()


# --- Programs and files ----------------------------------------------------------------------------


def test_a_path_as_text_is_read(tmp_path: Path) -> None:
    file = tmp_path / "plate.aidl"
    file.write_text(PLATE, "utf-8")
    for said in (file, str(file), f"{file}\n".strip()):
        assert aidl_lang.compile(said).ok
        assert aidl_lang.check(said) == []
    with pytest.raises(FileNotFoundError):
        aidl_lang.compile(str(tmp_path / "plane.aidl"))
    assert aidl_lang.compile(f"{PLATE} // plate.aidl").ok


@pytest.mark.parametrize("text", [PLATE, "solid plate { todo }\n" * 500], ids=["short", "long"])
def test_a_program_as_path_is_told(text: str) -> None:
    with pytest.raises(aidl_lang.AidlError, match="this Path holds a program") as told:
        aidl_lang.compile(Path(text))
    assert told.value.diagnostic.hints == ("give the program itself as a str",)


def test_what_is_neither_is_told(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="a program is a str, or a Path to it, not bytes"):
        aidl_lang.compile(PLATE.encode())  # type: ignore[arg-type]
    (tmp_path / "latin.aidl").write_bytes("// größer".encode("latin-1"))
    with pytest.raises(aidl_lang.AidlError, match="is not UTF-8 text") as told:
        aidl_lang.compile(tmp_path / "latin.aidl")
    assert told.value.diagnostic.code == "E0903"


# --- Writing files ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kerv": 1}, "there is no option `kerv`"),
        ({"output": "x"}, "there is no option `output`"),
        ({"kerf": "wide"}, "`kerf`: expected a length such as 3, 0.15mm or 0.1in, not `wide`"),
        ({"kerf": -1}, "`kerf`: expected a length such as 3, 0.15mm or 0.1in, not `-1`"),
        ({"kerf": float("nan")}, "`kerf`: expected a length such as 3, 0.15mm or 0.1in, not `NaN`"),
        ({"kerf": True}, "`kerf` has a value, and is not on or off"),
        ({"dimension": 3}, "`dimension` is on or off: `True` or `False`"),
        ({"sheet": object()}, "`sheet` takes numbers and texts, not `object`"),
        (
            {"show": "nams"},
            "`show`: there is no `nams`; there are names, points, bbox, constraints, dof, plan, numbers, "
            "list",
        ),
    ],
)
def test_options_that_are_refused(tmp_path: Path, options: dict[str, Any], message: str) -> None:
    with pytest.raises(aidl_lang.AidlError) as told:
        aidl_lang.compile(PLATE).save(tmp_path / "plate.svg", **options)
    assert str(told.value) == message
    assert [d.code for d in told.value.diagnostics] == ["E0925"]
    assert list(tmp_path.iterdir()) == []


def test_options_are_those_of_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same files come out, byte for byte."""
    monkeypatch.chdir(tmp_path)
    Path("plate.aidl").write_text(PLATE, "utf-8")
    model = aidl_lang.compile("plate.aidl")
    for suffix, keywords, words in (
        ("dxf", {"kerf": 0.15}, ["--kerf", "0.15"]),
        ("dxf", {"sheet": (200, 100), "spacing": 5.0}, ["--sheet", "200x100", "--spacing", "5"]),
        ("svg", {"tile": "a5", "overlap": "1cm", "pixels": None}, ["--tile", "a5", "--overlap", "10"]),
        ("svg", {"show": {"points", "names"}, "theme": "ink"}, ["--show", "names,points", "--theme", "ink"]),
        ("stl", {"thickness": 1e-5}, ["--thickness", "0.00001"]),
        ("png", {"pixels": 300, "dimension": True, "cut": False}, ["--pixels", "300", "--dimension"]),
    ):
        saved = model.save(f"python.{suffix}", **keywords)
        assert main(["compile", "plate.aidl", "-o", f"command.{suffix}", "--quiet", *words]) == 0
        for path in saved.paths:
            assert path.read_bytes() == Path(path.name.replace("python", "command")).read_bytes()
            path.unlink()


def test_all_sheets_are_written(tmp_path: Path) -> None:
    row = aidl_lang.compile(
        "assembly row { solid a { s = rectangle(90, 90) }\n solid b at (200, 0) { s = rectangle(90, 90) } }"
    )
    saved = row.save(tmp_path / "row.dxf", sheet="100x100")
    assert [path.name for path in saved.paths] == ["row.dxf", "row-2.dxf"]
    assert sorted(tmp_path.iterdir()) == sorted(saved.paths)
    with pytest.raises(aidl_lang.AidlError, match="2 files are no single content"):
        row.export(".dxf", sheet="100x100")


def test_what_does_not_hold_is_written_only_on_request(tmp_path: Path) -> None:
    model = aidl_lang.compile(FALSE)
    with pytest.raises(
        aidl_lang.AidlError, match="the model is not ok, so nothing is written without"
    ) as told:
        model.save(tmp_path / "disc.svg")
    assert told.value.diagnostics == tuple(d for d in model.diagnostics if d.is_error)
    assert list(tmp_path.iterdir()) == []
    model.save(tmp_path / "disc.svg", best_effort=True)
    assert (tmp_path / "disc.svg").exists()


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="there is no such folder"):
        aidl_lang.compile(PLATE).save(tmp_path / "nowhere" / "plate.svg")


@pytest.mark.parametrize(
    ("name", "message"),
    [("plate", "the name `plate` does not tell a format"), ("plate.sgv", "there is no format `sgv`")],
)
def test_a_format_that_is_not_known(name: str, message: str) -> None:
    with pytest.raises(aidl_lang.AidlError) as told:
        aidl_lang.compile(PLATE).save(name)
    assert str(told.value) == message
    assert told.value.__notes__ == [f"hint: formats: {', '.join(sorted(s[1:] for s in FORMATS))}"]


# --- Errors ----------------------------------------------------------------------------------------


def test_errors_carry_diagnostics() -> None:
    wrong, right = aidl_lang.compile(WRONG), aidl_lang.compile(PLATE)
    for attempt in (wrong.to_svg, lambda: wrong.solved, lambda: wrong.measure(), lambda: wrong["plate"]):
        with pytest.raises(aidl_lang.AidlError, match="the program is wrong") as told:
            attempt()
        assert told.value.diagnostics == tuple(wrong.diagnostics)
    for missing in (lambda: right["plat"], lambda: right.measure("plat")):
        with pytest.raises(KeyError) as lost:
            missing()
        assert isinstance(lost.value, aidl_lang.AidlError)
        assert lost.value.diagnostic.hints[0] == "did you mean `plate`?"
    with pytest.raises(aidl_lang.AidlError) as unread:
        aidl_lang.format("solid {")
    again = pickle.loads(pickle.dumps(unread.value))
    assert (type(again), str(again)) == (type(unread.value), str(unread.value))
    assert [d.message for d in again.diagnostics] == [d.message for d in unread.value.diagnostics]


# --- Params ----------------------------------------------------------------------------------------


def test_params_are_set_anew() -> None:
    lid = "assembly box { param w = 10 in 5..50\n solid lid { param h = 4\n r = rectangle(w, h) } }"
    model = aidl_lang.compile(lid, {"w": 20})
    other = model.with_params({"lid.h": 6}).with_params(w=30)
    assert {path: knob.value for path, knob in model.params.items()} == {"w": 20, "lid.h": 4}
    assert {path: knob.value for path, knob in other.params.items()} == {"w": 30, "lid.h": 6}
    assert (model.measure().area, other.measure().area) == (80, 180)
    assert model.params["w"].range == (5, 50)
    assert model.params["lid.h"].range is None
    assert [d.code for d in model.with_params(w=60).diagnostics] == ["E0909"]


# --- Copies ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", FEW)
def test_models_pickle(path: Path) -> None:
    model = example(path.stem)
    again: aidl_lang.Model = pickle.loads(pickle.dumps(model))
    assert again.to_json() == model.to_json()
    assert again.export(".svg", dimension=True) == model.export(".svg", dimension=True)
    assert aidl_lang.diff(model, again).is_equal
    assert again.params == model.params


def test_a_copy_has_its_imports_with_it(tmp_path: Path) -> None:
    (tmp_path / "lib.aidl").write_text("shape bar(w) { r = rectangle(width: w, height: 5) }", "utf-8")
    program = tmp_path / "part.aidl"
    program.write_text('import "lib.aidl"\nsolid part { param w = 10\n b = bar(w) }', "utf-8")
    model = aidl_lang.compile(program)
    again = pickle.loads(pickle.dumps(model))
    for file in tmp_path.iterdir():
        file.unlink()
    assert model.with_params(w=20).measure().area == 100
    assert again.with_params(w=20).measure().area == 100
    assert [d.code for d in aidl_lang.compile('import "lib.aidl"').diagnostics if d.is_error] == ["E0210"]


# --- Notebooks -------------------------------------------------------------------------------------


def test_what_a_notebook_shows() -> None:
    right, wrong = aidl_lang.compile(PLATE), aidl_lang.compile(WRONG)
    assert right._repr_svg_() == right.to_svg()
    assert right._repr_html_() is None
    assert wrong._repr_svg_() is None
    assert "did you mean `width`?" in _told(wrong)
    shown = aidl_lang.compile(FALSE)._repr_html_() or ""
    assert shown.startswith('<img alt="the drawing" src="data:image/svg+xml;base64,')
    assert "&lt;text&gt;:2:12" in shown
    assert "<text>" not in shown
