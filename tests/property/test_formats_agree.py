"""What is engraved as an area and what is cut is the same region in every format, whatever lies on what.

Each format is read by another reader, as a machine would: a DXF by alternation of all closed outlines of a
colour together, an SVG path by path, one over the other; PNG and PDF are looked at.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import replace
from functools import reduce

import ezdxf
import numpy as np
import pypdfium2
import pytest
from ezdxf.path import make_path
from hypothesis import example, given
from hypothesis import strategies as st
from PIL import Image
from shapely import Polygon, unary_union
from shapely.geometry.base import BaseGeometry
from svgelements import SVG, Close, Line
from svgelements import Path as SvgPath

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.export.job import Options
from aidl_lang.export.profiles import PROFILES
from tests.amount import tries

WIDTH, HEIGHT = 120, 80
"""Of a plate with areas on its left half and holes on its right half."""
PIXELS = 1200
CHORDS = 256
NEAR = 2.0
"""mm²: what 500 mm of edges enclose that are off by a twentieth of a pixel."""

places = st.tuples(st.integers(-44, -16), st.integers(-20, 20))
sizes = st.integers(3, 14)


@st.composite
def file_shapes(draw: st.DrawFn) -> str:
    """Shapes of a file, on one another, in an SVG of 40 mm."""
    x, y, size = draw(st.integers(5, 25)), draw(st.integers(5, 25)), draw(st.integers(3, 12))
    rule = draw(st.sampled_from(["nonzero", "evenodd"]))
    inner = f"M{x + 1} {y + 1}h{size - 2}v{size - 2}h{2 - size}z"
    return draw(
        st.sampled_from(
            [
                f'<rect x="{x}" y="{y}" width="{size}" height="{size + 3}"/>',
                f'<circle cx="{x}" cy="{y}" r="{size / 2}"/>',
                f'<path fill-rule="{rule}" d="M{x} {y}h{size}v{size}h{-size}z{inner}"/>',
            ]
        )
    )


@st.composite
def areas(draw: st.DrawFn) -> str:
    """A drawing that is engraved as an area."""
    (x, y), size = draw(places), draw(sizes)
    return draw(
        st.sampled_from(
            [
                f'drawing {{ t = text("Ag8", center: ({x}, {y}), height: {size}) }}',
                f"drawing {{ f = logo(center: ({x}, {y}), scale: {size / 20}, filled: true) }}",
                f'@layer("fill") drawing {{ c = circle(center: ({x}, {y}), radius: {size}) '
                f"r = rectangle(center: ({x}, {y + 3}), width: {size}, height: {size}) }}",
                f'@layer("fill") drawing {{ r = ring(center: ({x}, {y}), outer_radius: {size}, '
                f"inner_radius: {size / 2}) }}",
            ]
        )
    )


holes = st.builds(
    lambda at, size: f"circle(center: ({-at[0]}, {at[1]}), radius: {size / 2})", places, sizes
) | st.builds(
    lambda at, w, h: f"rectangle(center: ({-at[0]}, {at[1]}), width: {w}, height: {h})", places, sizes, sizes
)


def inked(picture: Image.Image, is_left: bool) -> float:
    """Returns the area of the darker ink on one half of the plate, mm², in a picture with a margin."""
    grey = np.asarray(picture.convert("L"), dtype=np.float64)
    rows, columns = grey.shape
    per_mm = PIXELS / (WIDTH * 1.06)
    middle, half = (rows / 2, columns / 2), (HEIGHT / 2 - 1, WIDTH / 2 - 1)
    top, bottom = (round(middle[0] + sense * half[0] * per_mm) for sense in (-1, 1))
    ends = sorted((round(middle[1] + (-1 if is_left else 1) * half[1] * per_mm), round(middle[1])))
    part = grey[top:bottom, ends[0] : ends[1]]
    paper = part[5, 5]
    ink = part.min() if is_left else part.max()
    return float(((paper - part) / (paper - ink)).sum() / per_mm**2) if paper != ink else 0.0


def of_pdf(data: bytes) -> Image.Image:
    with pypdfium2.PdfDocument(data) as document:
        page = document[0]
        return page.render(scale=PIXELS / page.get_width()).to_pil()


def in_svg(data: bytes, operation: str) -> float:
    """Returns the area that paths with an operation cover: each fills by alternation, one over the other."""
    paths = SVG.parse(io.BytesIO(data), ppi=25.4).elements(lambda e: isinstance(e, SvgPath))
    found = [p for p in paths if p.values["data-operation"] == operation]
    return float(unary_union([alternating(map(outline, path.as_subpaths())) for path in found]).area)


def outline(subpath: object) -> Polygon:
    spots: list[tuple[float, float]] = []
    for segment in SvgPath(subpath).segments()[1:]:
        chords = 1 if isinstance(segment, Line | Close) else CHORDS
        spots += map(tuple, segment.npoint(np.arange(chords) / chords))
    return Polygon(spots)


def in_dxf(data: bytes, layer: str) -> float:
    """Returns the area of all outlines of a layer, filled together by alternation."""
    document = ezdxf.read(io.StringIO(data.decode()))
    found = [make_path(e) for e in document.modelspace() if e.dxf.layer == layer]
    return float(alternating(Polygon([(p.x, p.y) for p in way.flattening(1e-4)]) for way in found).area)


def alternating(outlines: Iterable[Polygon]) -> BaseGeometry:
    return reduce(lambda a, b: a.symmetric_difference(b), (o.buffer(0) for o in outlines), Polygon())


@example(  # a disc on a square, in a file that is filled
    ['<rect x="5" y="5" width="30" height="30"/>', '<circle cx="20" cy="20" r="6"/>'],
    ["drawing { f = logo(center: (-30, 0), filled: true) }"],
    [],
)
@tries(16)
@given(
    st.lists(file_shapes(), min_size=1, max_size=4),
    st.lists(areas(), min_size=1, max_size=5),
    st.lists(holes, max_size=5),
)
def test_areas_are_the_same_in_all_formats(shapes: list[str], drawings: list[str], cuts: list[str]) -> None:
    page = 'xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40"'
    parts = [drawn.replace("drawing", f"drawing d{k}", 1) for k, drawn in enumerate(drawings)]
    parts += [f"hole h{k} {{ rim = {cut} }}" for k, cut in enumerate(cuts)]
    text = "\n".join(
        [
            'import "logo.svg" as logo',
            "@stroke(none) solid p {",
            f"body = rectangle(center: origin, width: {WIDTH}, height: {HEIGHT})",
            *parts,
            "}",
        ]
    )
    world = MemoryWorld({"logo.svg": f"<svg {page}>{''.join(shapes)}</svg>"})
    made = pipeline.compile(SourceFile("p.aidl", text), world)
    assert made.ok, made.diagnostics

    cutter = Options(profile=PROFILES["lightburn"])
    svg, dxf = (made.export(suffix, cutter) for suffix in (".svg", ".dxf"))
    looks = [Options(), cutter]
    png = [Image.open(io.BytesIO(made.export(".png", replace(look, pixels=PIXELS)))) for look in looks]
    pdf = [of_pdf(made.export(".pdf", look)) for look in looks]

    engraved = [in_svg(svg, "fill"), in_dxf(dxf, "C00-fill")]
    assert engraved[0] == pytest.approx(engraved[1], abs=0.5)
    assert [inked(picture, True) for picture in png + pdf] == pytest.approx([engraved[0]] * 4, abs=NEAR)

    removed = [in_svg(svg, "inner"), in_dxf(dxf, "C05-inner")]
    assert removed[0] == pytest.approx(removed[1], abs=0.5)
    assert [inked(made[0], False) for made in (png, pdf)] == pytest.approx([removed[0]] * 2, abs=NEAR)
