"""Dead links of a built site: of every page, to files and to places on pages."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


@dataclass
class _Page(HTMLParser):
    """The places on a page, and the links on it."""

    places: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        self.places.update(filter(None, (named.get("id"), named.get("name"))))
        self.links += filter(None, (named.get("href"), named.get("src")))


def read(folder: Path) -> dict[Path, _Page]:
    """Returns all pages below a folder."""
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        page = pages[path] = _Page()
        page.feed(path.read_text("utf-8"))
    return pages


def dead(folder: Path) -> list[str]:
    """Returns a line for each link of a built site that leads nowhere in it."""
    folder = folder.resolve()
    pages = read(folder)
    # the page of what is not found may be shown at any address, so its links are those of the root
    checked = {path: page for path, page in pages.items() if path.name != "404.html"}
    return [told for path, page in checked.items() for told in _dead_on(folder, path, page, pages)]


def outside(paths: Iterable[Path]) -> set[str]:
    """Returns the hosts of other machines that pages load scripts, styles or pictures from."""
    found = set()
    for path in paths:
        reader = _Loads()
        reader.feed(path.read_text("utf-8"))
        found |= {urlsplit(link).netloc for link in reader.links}
    return found - {""}


class _Loads(HTMLParser):
    """What a page loads by itself."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        link = named.get("src") if tag != "link" else named.get("href")
        if link and not (tag == "link" and named.get("rel") == "canonical"):
            self.links.append(link)


def _dead_on(folder: Path, path: Path, page: _Page, pages: Mapping[Path, _Page]) -> Iterator[str]:
    for link in dict.fromkeys(page.links):
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
        if target.is_dir():
            target /= "index.html"
        if not target.is_relative_to(folder) or not target.is_file():
            yield f"{path.relative_to(folder)}: {link}"
        elif parts.fragment and target in pages and not _is_place(parts.fragment, pages[target]):
            yield f"{path.relative_to(folder)}: {link} (no such place)"


def _is_place(fragment: str, page: _Page) -> bool:
    return unquote(fragment) in page.places or "code=" in fragment
