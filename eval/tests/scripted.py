"""A recording that is put together here: the same drawings in every language, to test the harness.

In AIDL (`full`) a drawing is a good program for its prompt. In each other language it is the regions of that
drawing, outline by outline, with its size as a named number at the head. Half of the conversations begin with
a mistake.

`python -m eval.tests.scripted FILE` writes it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from aidl_eval.plan import VARIANTS
from aidl_eval.regions import FINE, Regions, of_drawing
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.curves import union_bounds
from aidl_lang.geometry.region import Loop
from aidl_lang.pipeline import compile
from eval.tests.asked import NAMES, TEXTS
from tests.documents import ROOT

NOTE = (
    "scripted: drawings of one origin in every language, with mistakes put in; it tests the harness, no model"
)


def good(name: str) -> str:
    """Returns the good program for a prompt."""
    path = Path(__file__).parent / "programs" / f"{name}.aidl"
    return (path if path.exists() else ROOT / f"examples/{name}.aidl").read_text(encoding="utf-8")


@cache
def regions(name: str) -> Regions:
    """Returns what the good program for a prompt draws."""
    compiled = compile(SourceFile(f"{name}.aidl", good(name)))
    assert compiled.model is not None
    assert compiled.drawing is not None
    return of_drawing(compiled.model, compiled.drawing)


# --- a drawing, as it is written ---------------------------------------------------------------------

Outline = tuple[tuple[float, float], ...]
"""Corners as shares of the drawing's size."""


@dataclass(frozen=True)
class Area:
    outer: Outline
    holes: tuple[Outline, ...]


@dataclass(frozen=True)
class Plain:
    """Areas by part, back to front."""

    size: float
    parts: tuple[tuple[Area, ...], ...]


@cache
def plain(name: str) -> Plain:
    """Returns the drawing for a prompt, with its numbers as they are written."""
    drawn = regions(name)
    left, bottom, *_ = union_bounds([part.box for part in drawn.parts])

    def outline(loop: Loop) -> Outline:
        corners = (loop.polygon(FINE * drawn.size) - (left, bottom)) / drawn.size
        return tuple((round(float(x), 6), round(float(y), 6)) for x, y in corners)

    parts = tuple(
        tuple(Area(outline(f.outer), tuple(map(outline, f.holes))) for f in part.faces)
        for part in drawn.parts
    )
    return Plain(round(drawn.size, 2) + 0.003, parts)  # no whole number, which edits would keep whole


# --- the languages -----------------------------------------------------------------------------------


def aidl(name: str, variant: str) -> str:
    """Returns the drawing as solids beside each other, or, without hierarchy, as outlines in one solid."""
    drawing = plain(name)
    is_flat, has_cuts = variant == "no-hierarchy", variant != "paper"
    size = drawing.size
    lines = [f"    param size = {size:g} in {size / 2:g}..{2 * size:g}"]
    for number, areas in enumerate(drawing.parts):
        if not is_flat:
            lines.append(f"    solid part_{number} {{")
        for k, area in enumerate(areas):
            if k and not has_cuts:  # a hole cuts all of its solid
                lines.append(f"    }}\n    solid part_{number}_{k} {{")
            stem = f"face_{number}_{k}"
            lines.append(f"        {stem} = {_aidl(area.outer)}")
            for h, hole in enumerate(area.holes):
                it = f"{stem}_hole_{h}"
                lines.append(
                    f"        {it} = {_aidl(hole)}"
                    if has_cuts
                    else f"        hole {it} {{ rim = {_aidl(hole)} }}"
                )
            if area.holes and has_cuts:
                cuts = ", ".join(f"{stem}_hole_{h}" for h in range(len(area.holes)))
                lines.append(f"        {stem}_cut = cut({stem}, {cuts})")
        if not is_flat:
            lines.append("    }")
    kind = "solid" if is_flat else "assembly"
    return "\n".join((f"/// {TEXTS[name]}", f"{kind} {name} {{", *lines, "}", ""))


def _aidl(outline: Outline) -> str:
    return f"polygon([{', '.join(f'({x} * size, {y} * size)' for x, y in outline)}])"


def openscad(name: str) -> str:
    """Returns the drawing with a module for each part."""
    drawing = plain(name)
    lines = [f"// {TEXTS[name]}", f"size = {drawing.size:g};"]
    for number, areas in enumerate(drawing.parts):
        lines.append(f"module part_{number}() {{")
        for area in areas:
            holes = " ".join(map(_openscad, area.holes))
            outer = _openscad(area.outer)
            lines.append(f"    difference() {{ {outer} {holes} }}" if holes else f"    {outer}")
        lines.append("}")
    lines += [f"part_{number}();" for number in range(len(drawing.parts))]
    return "\n".join((*lines, ""))


def _openscad(outline: Outline) -> str:
    return f"polygon({[list(corner) for corner in outline]} * size);"


def build123d(name: str) -> str:
    return _python(
        name,
        "from build123d import *",
        "def polygon(*points):\n"
        "    return make_face(Polyline(*[(x * size, y * size) for x, y in points], close=True))\n",
        "def cut(outer, *holes):\n    for hole in holes:\n        outer -= hole\n    return outer\n",
    )


def cadquery(name: str) -> str:
    return _python(
        name,
        "import cadquery as cq",
        "def polygon(*points):\n"
        "    return cq.Sketch().polygon([(x * size, y * size) for x, y in [*points, points[0]]])\n",
        "def cut(outer, *holes):\n"
        "    for hole in holes:\n        outer = outer.face(hole, mode='s')\n    return outer\n",
    )


def _python(name: str, head: str, *functions: str) -> str:
    drawing = plain(name)
    lines = [
        f"# {TEXTS[name]}",
        head,
        "",
        f"size = {drawing.size:g}",
        "",
        *functions,
    ]
    for areas in drawing.parts:
        shown = ", ".join(
            f"cut({', '.join(map(_called, (area.outer, *area.holes)))})"
            if area.holes
            else _called(area.outer)
            for area in areas
        )
        lines.append(f"show_object([{shown}])")
    return "\n".join((*lines, ""))


def _called(outline: Outline) -> str:
    return f"polygon({', '.join(map(str, outline))})"


def svg(name: str) -> str:
    """Returns the drawing with a path for each part."""
    drawing = plain(name)
    size = drawing.size
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {-size:g} {size:g} {size:g}">']
    for areas in drawing.parts:
        d = " ".join(_path(o, size) for area in areas for o in (area.outer, *area.holes))
        lines.append(f'  <path fill-rule="evenodd" d="{d}"/>')
    return "\n".join((*lines, "</svg>", ""))


def _path(outline: Outline, size: float) -> str:
    return "M" + " L".join(f"{x * size:.5f} {-y * size:.5f}" for x, y in outline) + "Z"


WRITERS: Mapping[str, Callable[[str], str]] = {
    "full": good,
    **{v: lambda name, v=v: aidl(name, v) for v in ("no-hierarchy", "no-constraints", "paper")},  # type: ignore[misc]
    "openscad": openscad,
    "build123d": build123d,
    "cadquery": cadquery,
    "svg": svg,
}


# --- mistakes, and the recording ---------------------------------------------------------------------

Mistake = Callable[[str], str]


def _after(text: str) -> Mistake:
    return lambda program: program + text


_AIDL: Sequence[Mistake] = (
    lambda program: f'{program.rstrip().removesuffix("}")}    assert 2 < 1, "never"\n}}\n',
    lambda program: program.replace(" = ", " = nowhere + ", 1),
)
_PYTHON: Sequence[Mistake] = (_after("open('/etc/passwd')\n"), _after("show_object(nowhere)\n"))
MISTAKES: Mapping[str, Sequence[Mistake]] = {
    **dict.fromkeys(("full", "no-hierarchy", "no-constraints", "paper"), _AIDL),
    "openscad": (_after('import("/etc/drawing.svg");\n'), _after("square(3 4);\n")),
    "build123d": _PYTHON,
    "cadquery": _PYTHON,
    "svg": (
        lambda program: '<!DOCTYPE svg [<!ENTITY a "b">]>' + program,
        lambda program: program.replace("</svg>", "<g>"),
    ),
}
"""What is wrong in a first reply; the second is right. A third mistake is to answer without a program."""


def mistake(name: str) -> int:
    """Returns which mistake the first reply to a prompt has, where it has one."""
    return NAMES.index(name) // 2 % 3


def replies(name: str, variant: str) -> list[str]:
    """Returns the replies of a conversation: every other one has a mistake first, all kinds in turn."""
    program = WRITERS[variant](name)
    right = _fenced(program, variant)
    if NAMES.index(name) % 2 == 0:
        return [right]
    kinds, kind = MISTAKES[variant], mistake(name)
    wrong = "First I think about it." if kind == len(kinds) else _fenced(kinds[kind](program), variant)
    return [wrong, right]


def _fenced(program: str, variant: str) -> str:
    return f"Here it is.\n\n```{VARIANTS[variant].fences[0]}\n{program}```\n"


def recording(names: Sequence[str] = NAMES, variants: Sequence[str] = tuple(WRITERS)) -> str:
    """Returns a recording with one conversation for each of these prompts in each of these languages."""
    lines = (
        {
            "aidl_recording": 1,
            "prompt": name,
            "text": TEXTS[name],
            "variant": variant,
            "run": 1,
            "note": NOTE,
            "replies": replies(name, variant),
        }
        for variant in variants
        for name in names
    )
    return "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(recording(), encoding="utf-8")
