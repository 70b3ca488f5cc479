"""The site: links into the playground open what is shown, no link leads nowhere, pictures are those of the
programs before them, and the tutorial goes as it says.
"""

from __future__ import annotations

import html
import re
import tomllib
import zlib
from base64 import urlsafe_b64decode
from collections.abc import Iterator
from pathlib import Path

import pytest

from aidl_lang.tools.reference.collect import reference
from aidl_site import checking, pictures
from aidl_site.__main__ import CONFIGURATION
from aidl_site.blocks import address, can_open, split, written
from aidl_site.readme import outside
from aidl_site.staging import Staging
from tests.commands import Aidl
from tests.commands import aidl as aidl
from tests.documents import ROOT, Block, blocks
from tests.sweep.here import at_once as at_once

TUTORIAL = ROOT / "docs" / "tutorial.md"
GALLERY = [path.stem for path in sorted((ROOT / "examples" / "gallery").glob("*.aidl"))]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the site is built from."""
    staging = Staging(ROOT, tmp_path_factory.mktemp("site") / "pages", has_playground=True)
    staging.write()
    assert staging.dead == []
    return staging.folder


def opened(link: str) -> str:
    """The program that the playground shows for a link: what its own reader does."""
    code = link.partition("#")[2].rpartition("code=")[2]
    return zlib.decompress(urlsafe_b64decode(code + "=" * (-len(code) % 4)), -15).decode()


@pytest.mark.parametrize("program", ["", "solid a { }\n", "// größer – 你好\nsolid a {\n}\n" * 400])
def test_a_link_holds_the_program(program: str) -> None:
    link = address(program, 2)
    assert re.fullmatch(r"\.\./\.\./playground/#code=[\w-]*", link)
    assert opened(link) == program


def test_every_program_that_stands_alone_has_a_link_that_opens_it(pages: Path) -> None:
    tried = 0
    for page in sorted((ROOT / "docs").rglob("*.md")):
        home = pages / page.relative_to(ROOT / "docs")
        home = home.with_name("index.md") if home.name == "README.md" else home
        shown = [b.text for b in blocks(page) if can_open(b.language, b.note, b.text)]
        text = home.read_text("utf-8")
        links = re.findall(r'<p class="aidl-open" data-search-exclude><a href="([^"]+)">', text)
        assert [opened(html.unescape(link)) for link in links] == shown, page
        for link in links:
            folder = (home.parent / link.partition("#")[0]).resolve()
            assert folder == (pages / "playground").resolve(), page
        tried += len(links)
    assert tried > 600


def test_every_picture_of_the_gallery_can_be_edited(pages: Path) -> None:
    text = (pages / "gallery.md").read_text("utf-8")
    links = re.findall(r'<a class="aidl-edit" href="([^"]+)">edit</a>', text)
    programs = [(ROOT / "examples" / "gallery" / f"{name}.aidl").read_text("utf-8") for name in GALLERY]
    assert [opened(html.unescape(link)) for link in links] == programs
    assert [link.partition("#name=")[2].partition("&")[0] for link in links] == [f"{n}.aidl" for n in GALLERY]


def test_what_does_not_stand_alone_has_no_link() -> None:
    assert "playground" in written("```aidl\nsolid a { }\n```\n", 0, True)
    assert "playground" in written("```aidl error\nsolid a { }\n```\n", 0, True)
    for block in (
        "```aidl fragment\nsolid a\n```\n",
        "```aidl file=b.aidl\nsolid a { }\n```\n",
        '```aidl\nimport "b.aidl"\n```\n',
        "```text\nsolid a { }\n```\n",
    ):
        assert "playground" not in written(block, 0, True)
    drawing = written("```aidl file=logo.svg\n<svg/>\n```\n", 0, True)
    assert drawing == '```xml title="logo.svg"\n<svg/>\n```\n'


def test_links_in_code_stay_as_they_are(tmp_path: Path) -> None:
    """And those out of `docs/` are led to where their targets go."""
    (tmp_path / "docs" / "diagnostics").mkdir(parents=True)
    (tmp_path / "examples").mkdir()
    (tmp_path / "examples" / "a.aidl").write_text("solid a { }\n")
    for name in ("README.md", "CHANGELOG.md"):
        (tmp_path / name).write_text("# A page\n")
    (tmp_path / "CONTRIBUTING.md").write_text("# Contributing\n")
    page = "# A\n\n`[x](gone.md)` [y](../examples/a.aidl) [z](gone.md)\n\n```text\n[x](gone.md)\n```\n"
    (tmp_path / "docs" / "a.md").write_text(page)
    staging = Staging(tmp_path, tmp_path / "pages", has_playground=False)
    staging.write()
    assert staging.dead == ["docs/a.md: gone.md"]
    assert "[y](examples/a.md)" in (tmp_path / "pages" / "a.md").read_text()
    assert "solid a { }" in (tmp_path / "pages" / "examples" / "a.md").read_text()


def test_pieces_of_a_page_are_the_page() -> None:
    text = TUTORIAL.read_text("utf-8")
    pieces = split(text)
    assert "".join(piece for _, piece in pieces) == text
    assert sum(is_block for is_block, _ in pieces) == len(list(blocks(TUTORIAL)))


def test_dead_links_of_a_built_site_are_told(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "index.html").write_text('<h1 id="top">A</h1><a href="../b.html#here">b</a>')
    (tmp_path / "b.html").write_text(
        '<p id="here"><a href="a/">a</a><a href="a/#top">t</a><a href="a/#gone">g</a>'
        '<img src="gone.svg"><a href="https://example.org/gone">o</a><a href="../out.html">x</a></p>'
    )
    assert checking.dead(tmp_path) == [
        "b.html: a/#gone (no such place)",
        "b.html: gone.svg",
        "b.html: ../out.html",
    ]


def test_the_menu_names_pages_that_there_are_and_all_of_the_reference(pages: Path) -> None:
    def named(entry: object) -> Iterator[str]:
        if isinstance(entry, str):
            yield entry
        elif isinstance(entry, dict):
            for inner in entry.values():
                yield from named(inner)
        elif isinstance(entry, list):
            for inner in entry:
                yield from named(inner)

    menu = list(named(tomllib.loads(CONFIGURATION.read_text("utf-8"))["project"]["nav"]))
    assert [page for page in menu if not (pages / page).is_file()] == []
    assert len(set(menu)) == len(menu)
    topics = {f"reference/{topic.name}.md" for topic in reference().topics}
    found = {p.relative_to(ROOT / "docs").as_posix() for f in ("start", "howto") for p in _pages(f)}
    hand_written = {path.replace("README.md", "index.md") for path in found}
    assert sorted((topics | hand_written) - set(menu)) == []


def _pages(folder: str) -> list[Path]:
    return sorted((ROOT / "docs" / folder).glob("*.md"))


def test_pictures_are_those_of_the_programs_before_them() -> None:
    drawn = pictures.pictures(ROOT)
    there = {path: (ROOT / path).read_bytes() for path in drawn if (ROOT / path).is_file()}
    stale = [path for path, data in drawn.items() if there.get(path) != data]
    assert stale == [], "run `make reference`"
    folders = {path.rpartition("/")[0] for path in drawn}
    found = {p.relative_to(ROOT).as_posix() for folder in folders for p in (ROOT / folder).glob("*")}
    assert sorted(found - drawn.keys()) == [], "nothing shows these"
    assert len(drawn) > 25


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at_once: None) -> Path:
    """The folder that commands run in."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    return tmp_path


# --- The tutorial ----------------------------------------------------------------------------------


def test_the_tutorial_goes_as_it_says(aidl: Aidl, folder: Path) -> None:
    """Each command is given for the program before it, and says what the page says; `…` is anything."""
    ran = 0
    mistaken = False
    for block in blocks(TUTORIAL):
        if block.language == "aidl":
            mistaken = block.note == "error"
            (folder / "rack.aidl").write_text(block.text)
        elif block.language == "console":
            for command, said in _commands(block):
                if command[0] != "aidl":
                    continue
                ran += 1
                result = aidl(*command[1:])
                fails = mistaken or "--ends" in command
                assert result.code == (1 if fails else 0), (command, result)
                lines = result.out + result.err
                assert re.search(_pattern(said), lines), f"{' '.join(command)} says\n{lines}"
    assert ran >= 9


PART = """
@thickness(4mm) @material("birch")
solid part {
    body = rectangle(center: fixed((0, 0)), width: 60, height: 30)
    hole eye { rim = circle(center: fixed((0, 0)), radius: 4) }
}
"""
SERVERS = ("preview", "mcp", "lsp", "generate")


@pytest.mark.parametrize("page", [*_pages("howto"), *_pages("start")], ids=lambda page: page.stem)
def test_commands_on_a_page_are_understood(page: Path, aidl: Aidl, folder: Path) -> None:
    """With a part in place of the program that they name."""
    commands = [
        words for block in blocks(page) if block.language == "console" for words, _ in _commands(block)
    ]
    for words in commands:
        if words[0] != "aidl" or words[1] in SERVERS:
            continue
        for name in words[2:]:
            if name.endswith(".aidl"):
                (folder / name).write_text(PART)
        if words[1] == "new":
            (folder / f"{words[2]}.aidl").unlink(missing_ok=True)
        result = aidl(*(word.strip("'") for word in words[1:]))
        assert result.code == 0, (words, result)


def _commands(block: Block) -> Iterator[tuple[list[str], str]]:
    for piece in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
        line, _, said = piece.partition("\n")
        yield line.split(), said


def _pattern(said: str) -> str:
    return re.escape(said.strip()).replace("…", r"[\s\S]*?")


# --- The README elsewhere --------------------------------------------------------------------------


def test_the_readme_leads_to_the_site_wherever_it_is_read() -> None:
    text = outside(ROOT, "https://example.org/aidl")
    links = re.findall(r"\]\(([^)]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text)
    assert [link for link in links if not link.startswith("https://")] == []
    shown = re.findall(
        r'<a href="https://example\.org/aidl/playground/(#[^"]+)"><img src="[^"]+/(\w+)\.svg"', text
    )
    programs = {name: (ROOT / "examples" / "gallery" / f"{name}.aidl").read_text("utf-8") for name in GALLERY}
    assert {name: opened(link) for link, name in shown} == programs
    for name in ("telephone", "motor_bracket"):
        picture = re.search(rf"\[!\[[^\]]+\]\([^)]+/images/{name}\.svg\)\]\(([^)]+)\)", text)
        assert picture
        assert opened(picture[1]) == (ROOT / "examples" / f"{name}.aidl").read_text("utf-8")
    assert "https://example.org/aidl/reference/index.html" in links
    assert "Open in the playground" not in text
