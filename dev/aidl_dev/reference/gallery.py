"""The gallery: a page that shows the programs of `examples/gallery` with their pictures, knobs and looks."""

from __future__ import annotations

from pathlib import Path

from aidl_dev.reference.llms import headline
from aidl_dev.reference.pages import page_of
from aidl_lang.tools.reference import picture_of

FOLDER = "examples/gallery"
PAGE = "docs/gallery.md"
IMAGES = "docs/images/gallery"
_WIDTH = 300
"""Width of a picture on the page, in pixels."""
_LOOKED_AT = "lighthouse"
_THEMES = ("blueprint", "ink", "cutter")

_INTRODUCTION = """\
Programs of at most a hundred lines. Each knob may be turned to both ends of its range, and no message
comes: a test turns them all.
"""
_LOOKS = """\
`aidl compile --theme` draws any program as a blueprint, in ink, or as the outlines that a cutter follows.
"""


def programs(root: Path) -> list[Path]:
    return sorted((root / FOLDER).glob("*.aidl"))


def page(root: Path) -> str:
    """Returns the page for the checkout at `root`."""
    blocks = ["# Gallery", _INTRODUCTION]
    for path in programs(root):
        text = path.read_text("utf-8")
        name = path.stem.replace("_", " ")
        link = f"[{path.name}](../{FOLDER}/{path.name}), {len(text.splitlines())} lines."
        blocks += [
            f"## {name.capitalize()}",
            _image(path.stem, name),
            f"{headline(text)} {link}",
            _knobs(text),
        ]
    shown = [_image(f"{_LOOKED_AT}-{theme}", f"{_LOOKED_AT}, {theme}") for theme in _THEMES]
    return page_of([*blocks, "## Other looks", _LOOKS, "\n".join(shown)])


def pictures(root: Path) -> dict[str, bytes]:
    """Returns the drawings on the page by their paths below the root. Raises ValueError if a program does not
    compile.
    """
    drawn = {
        f"{IMAGES}/{path.stem}.svg": picture_of(path.name, path.read_text("utf-8")) for path in programs(root)
    }
    text = (root / FOLDER / f"{_LOOKED_AT}.aidl").read_text("utf-8")
    looks = {
        f"{IMAGES}/{_LOOKED_AT}-{theme}.svg": picture_of(_LOOKED_AT, text, theme=theme) for theme in _THEMES
    }
    return drawn | looks


def image_paths(root: Path) -> list[str]:
    """Returns the paths of all pictures below the root."""
    names = [path.stem for path in programs(root)] + [f"{_LOOKED_AT}-{theme}" for theme in _THEMES]
    return [f"{IMAGES}/{name}.svg" for name in names]


def _image(name: str, about: str) -> str:
    return f'<img src="images/gallery/{name}.svg" alt="{about}" width="{_WIDTH}">'


def _knobs(text: str) -> str:
    lines = [line.strip() for line in text.splitlines()]
    return "\n".join(["```text", *(line for line in lines if line.startswith("param ")), "```"])
