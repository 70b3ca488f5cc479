"""The pages that the site is built from: those of `docs/`, what they link to elsewhere in the checkout, and
an index of the diagnostics. Their Markdown is that of the checkout but for links, blocks and pictures.
"""

from __future__ import annotations

import html
import os.path
import re
import shutil
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from aidl_site.blocks import PLAYGROUND, address, can_open, opening, split, written

INDEX = "index.md"
_TARGET = re.compile(r"(\]\(<?)([^)\s>]+)(>?\))|((?:src|href)=\")([^\"]+)(\")")
_SPAN = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
_PICTURE = re.compile(r'<img src="images/gallery/(\w+)\.svg"[^>]*>')
_SHOWN = re.compile(r'<a href="docs/gallery\.md[^"]*">(?=<img src="docs/images/gallery/(\w+)\.svg")')
"""The link of a picture of the gallery in the README."""
_DRAWN = re.compile(r"!\[[^\]]*\]\(docs/images/(\w+)\.svg\)")
"""A picture of another example there."""
_OUTSIDE = re.compile(r"[a-z][a-z0-9+.-]*:|//|#")
_GUIDES = "docs/guides"
"""Guides to parts of the language, which only evaluations hand out: built, and left out of the search, as are
the source of the library and documents that are tests."""
_UNSEARCHED = "---\nsearch:\n  exclude: true\n---\n\n"
_FIRST = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/diagnostics")
"""What the site has beside the files of `docs/`, linked or not."""
_FAMILIES = {
    "01": "Syntax",
    "02": "Names",
    "03": "Types and arguments",
    "04": "What may refer to what",
    "05": "Building the model",
    "06": "Solving",
    "07": "Regions and drawings",
    "08": "Limits",
    "09": "Files and use",
}
"""What the first two digits of a code say."""


class Staging:
    """Writes the pages below a folder. Links that lead nowhere in the checkout are kept in `dead`.

    address  where the site is, for links that hold elsewhere too; else they are relative
    """

    def __init__(self, root: Path, folder: Path, has_playground: bool, address: str = "") -> None:
        self.root, self.folder, self.has_playground, self.address = root, folder, has_playground, address
        self.dead: list[str] = []
        self._waiting: list[PurePosixPath] = []
        self._known: set[PurePosixPath] = set()

    def write(self) -> None:
        """Writes everything that the site is built from."""
        shutil.rmtree(self.folder, ignore_errors=True)
        for name in (*_FIRST, *self._pages_and_pictures()):
            self._want(PurePosixPath(name))
        while self._waiting:
            self._stage(self._waiting.pop())

    # --- Where things go --------------------------------------------------------------------------

    def _pages_and_pictures(self) -> Iterator[str]:
        for path in sorted((self.root / "docs").rglob("*")):
            if path.is_file():
                yield path.relative_to(self.root).as_posix()

    def _home(self, path: PurePosixPath) -> PurePosixPath:
        """Returns where a file or folder of the checkout goes, below the root of the pages."""
        if path == PurePosixPath("README.md"):
            return PurePosixPath("about.md")  # the site begins with `docs/README.md`
        short = PurePosixPath(*path.parts[1:]) if path.parts[0] == "docs" else path
        if (self.root / path).is_dir():
            return short / INDEX
        if path.name == "README.md":
            return short.with_name(INDEX)
        return short.with_suffix(".md") if path.suffix == ".aidl" else short

    def _want(self, path: PurePosixPath) -> None:
        if path not in self._known:
            self._known.add(path)
            self._waiting.append(path)

    def _put(self, home: PurePosixPath, text: str) -> None:
        target = self.folder / home
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")

    # --- One file ---------------------------------------------------------------------------------

    def _stage(self, path: PurePosixPath) -> None:
        source, home = self.root / path, self._home(path)
        if path == PurePosixPath("docs/diagnostics"):
            self._put(home, self._diagnostics())
        elif source.is_dir():
            self._put(home, self._listing(path))
        elif path.suffix == ".md":
            self._put(home, self.page(path))
        elif path.suffix == ".aidl":
            self._put(home, self._program(path, source.read_text("utf-8")))
        else:
            (self.folder / home).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, self.folder / home)

    def page(self, path: PurePosixPath) -> str:
        """Returns a page of the checkout as it is on the site."""
        text, depth = (self.root / path).read_text("utf-8"), len(self._home(path).parts) - 1
        is_linked = self.has_playground and not self.address
        pieces = [
            written(piece, depth, is_linked) if is_block else self._prose(path, piece)
            for is_block, piece in split(text)
        ]
        is_unsearched = path.is_relative_to(_GUIDES) or path.parts[0] == "tests"
        return _UNSEARCHED * is_unsearched + "".join(pieces)

    def _prose(self, path: PurePosixPath, text: str) -> str:
        """Returns prose with its links led to where their targets go; spans of code stay as they are."""
        text = self._with_edits(text) if self.has_playground else text
        parts, place = [], 0
        for span in _SPAN.finditer(text):
            parts += [self._led(path, text[place : span.start()]), span[0]]
            place = span.end()
        return "".join([*parts, self._led(path, text[place:])])

    def _with_edits(self, text: str) -> str:
        """Returns prose in which pictures of examples open their programs in the playground."""

        def link(program: str) -> str | None:
            path = self.root / "examples" / f"{program}.aidl"
            return self.address + address(path.read_text("utf-8"), 0, path.name) if path.is_file() else None

        def edited(found: re.Match[str]) -> str:
            if (target := link(f"gallery/{found[1]}")) is None:
                return found[0]
            opens = f'href="{html.escape(target)}"'
            if found[0].startswith("<a "):
                return f"<a {opens}>"
            return f'<a {opens}>{found[0]}</a>\n<a class="aidl-edit" {opens}>edit</a>'

        def drawn(found: re.Match[str]) -> str:
            return found[0] if (target := link(found[1])) is None else f"[{found[0]}]({target})"

        return _DRAWN.sub(drawn, _SHOWN.sub(edited, _PICTURE.sub(edited, text)))

    def _led(self, path: PurePosixPath, text: str) -> str:
        def led(found: re.Match[str]) -> str:
            before, target, after = found.group(1, 2, 3) if found[2] else found.group(4, 5, 6)
            return f"{before}{self._target(path, target, is_html=not found[2])}{after}"

        return _TARGET.sub(led, text)

    def _target(self, path: PurePosixPath, target: str, is_html: bool) -> str:
        """Returns a link of a page as it is from where the page goes."""
        if _OUTSIDE.match(target) or target.startswith((PLAYGROUND, f"../{PLAYGROUND}")):
            return target
        file, mark, place = target.partition("#")
        wanted = PurePosixPath(os.path.normpath(path.parent / file))
        if wanted.parts[0] == ".." or not (self.root / wanted).exists():
            self.dead.append(f"{path}: {target}")
            return target
        if (self.root / wanted / "README.md").is_file():
            wanted /= "README.md"
        self._want(wanted)
        home = self._home(wanted)
        if (is_html or self.address) and home.suffix == ".md":
            home = home.with_suffix(".html")
        link = f"{self.address}{home}" if self.address else os.path.relpath(home, self._home(path).parent)
        return link + mark + place

    # --- Pages that are made ----------------------------------------------------------------------

    def _program(self, path: PurePosixPath, text: str) -> str:
        is_linked = self.has_playground and can_open("aidl", "", text)
        link = opening(text, len(path.parts) - 1, path.name) if is_linked else ""
        head = _UNSEARCHED * (path.parts[0] == "stdlib")
        return f"{head}# {path.name}\n\n`{path}`\n\n{link}\n\n```aidl\n{text}```\n"

    def _listing(self, path: PurePosixPath) -> str:
        programs = sorted((self.root / path).glob("*.aidl"))
        for program in programs:
            self._want(path / program.name)
        lines = [f"- [{program.name}]({program.stem}.md)" for program in programs]
        return f"# {path.name.capitalize()}\n\n" + "\n".join(lines) + "\n"

    def _diagnostics(self) -> str:
        """Returns the index of the pages on diagnostics, by family."""
        found = sorted((self.root / "docs" / "diagnostics").glob("*.md"), key=lambda page: page.stem[1:])
        lines = ["# What messages mean", "", "`aidl explain CODE` prints the same pages. E is an error, W a "]
        lines[-1] += "warning, N a note."
        group = ""
        for page in found:
            code, _, title = page.read_text("utf-8").splitlines()[0].removeprefix("# ").partition(": ")
            if code[1:3] != group:
                group = code[1:3]
                lines += ["", f"## {_FAMILIES[group]}", ""]
            lines.append(f"- [{code}]({code}.md) {title}")
        return "\n".join(lines) + "\n"
