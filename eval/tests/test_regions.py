"""Regions of any language: measures against shapely on drawn examples, order, and their pictures."""

from __future__ import annotations

import io

import numpy as np
import pytest
import shapely
from PIL import Image
from shapely import affinity

from aidl_eval import pictures
from aidl_eval.regions import Regions, of_drawing
from aidl_eval.shapes import region
from aidl_eval.whole import MEASURES
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import compile

Shape = shapely.Polygon | shapely.MultiPolygon


def regions(*shapes: Shape) -> Regions:
    return Regions(tuple(region(outlines(shape)) for shape in shapes))


def outlines(shape: Shape) -> list[np.ndarray]:
    parts = shape.geoms if isinstance(shape, shapely.MultiPolygon) else [shape]
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    return [np.array(ring.coords)[:-1] for ring in rings]


def disc(x: float, y: float, r: float, sides: int = 64) -> shapely.Polygon:
    return shapely.Point(x, y).buffer(r, quad_segs=sides // 4)


BODY = shapely.box(0, 10, 100, 40)
WHEELS = [disc(20, 10, 10), disc(80, 10, 10.2)]
CART = regions(BODY, *WHEELS)
SILHOUETTE = shapely.union_all([BODY, *WHEELS])


def measured(name: str, drawn: Regions) -> float:
    return MEASURES[name](drawn)


def test_measures_agree_with_shapely() -> None:
    left, bottom, right, top = SILHOUETTE.bounds
    assert CART.whole.area == pytest.approx(SILHOUETTE.area, rel=1e-6)
    assert measured("fullness", CART) == pytest.approx(
        SILHOUETTE.area / ((right - left) * (top - bottom)), rel=1e-6
    )
    mirrored = affinity.scale(SILHOUETTE, -1, 1, origin=SILHOUETTE.centroid)
    assert measured("symmetry", CART) == pytest.approx(
        SILHOUETTE.intersection(mirrored).area / SILHOUETTE.area, rel=1e-4
    )
    for name, share in (("width_at_bottom", 0.05), ("width_at_middle", 0.5), ("width_at_top", 0.95)):
        y = bottom + share * (top - bottom)
        across = SILHOUETTE.intersection(shapely.box(left, y, right, y + 1e-3 * (top - bottom))).bounds
        assert measured(name, CART) == pytest.approx((across[2] - across[0]) / (right - left), rel=1e-3)
    assert (measured("width", CART), measured("height", CART)) == pytest.approx((right - left, top - bottom))


def test_what_is_covered_is_not_seen() -> None:
    seen = [region.area for region in CART.visible]
    assert seen[0] == pytest.approx(BODY.difference(shapely.union_all(WHEELS)).area, rel=1e-6)
    assert seen[1] == pytest.approx(WHEELS[0].area, rel=1e-6)
    assert measured("fields", CART) == 3
    assert measured("fields", regions(*WHEELS, shapely.box(-50, -50, 150, 150))) == 1
    ring = shapely.box(0, 0, 9, 9).difference(shapely.box(3, 3, 6, 6))
    assert measured("fields", regions(ring)) == 2


@pytest.mark.parametrize(
    ("shapes", "rounds"),
    [
        ([BODY, *WHEELS], 2),
        ([disc(0, 0, 10), disc(30, 0, 11)], 1),
        ([shapely.box(0, 0, 90, 30).difference(shapely.union_all([disc(x, 15, 4) for x in (9, 45, 80)]))], 3),
        ([shapely.box(0, 0, 9, 9), affinity.scale(disc(0, 0, 9), 1, 0.9)], 0),
        ([shapely.box(0, 0, 10, 10).buffer(4)], 0),
        ([disc(0, 0, 9, 12)], 1),
        ([disc(0, 0, 9, 8)], 0),
        ([shapely.box(-99, -99, 99, 99), disc(0, 0, 0.3), disc(5, 5, 0.3)], 0),  # slivers
    ],
)
def test_round_things_of_one_size_are_counted(shapes: list[Shape], rounds: int) -> None:
    assert measured("rounds", regions(*shapes)) == rounds


def test_alike_are_outlines_of_one_size_and_area() -> None:
    slats = [shapely.box(x, 0, x + 5, 40) for x in range(0, 60, 10)]
    triangle = shapely.Polygon([(90, 0), (95, 0), (90, 40)])
    assert measured("alike", regions(*slats, triangle)) == 6


def test_nothing_has_no_measures() -> None:
    for name in ("fullness", "width", "symmetry", "width_at_top"):
        assert np.isnan(measured(name, Regions()))
    assert [measured(name, Regions()) for name in ("rounds", "alike", "fields", "pieces")] == [0, 0, 0, 0]


AIDL = """
assembly cart {
    @color("navy") solid body {
        plank = rectangle(center: (0, 20), width: 60, height: 20)
        solid seat { back = rectangle(center: (-20, 40), width: 10, height: 40) }
    }
    @color("red") solid wheel { rim = circle(center: (20, 10), radius: 8) }
    drawing axle { line = line(start: (-30, 10), end: (30, 10)) }
}
"""


def test_aidl_is_taken_apart_into_bodies_and_what_they_are_united_of() -> None:
    compiled = compile(SourceFile("cart.aidl", AIDL))
    assert compiled.model is not None
    assert compiled.drawing is not None
    drawn = of_drawing(compiled.model, compiled.drawing)
    assert [part.area for part in drawn.parts] == pytest.approx([60 * 20, 400, np.pi * 64])
    assert len(drawn.lines) == 1


def test_pictures_are_of_one_style() -> None:
    with Image.open(io.BytesIO(pictures.png(regions(BODY, WHEELS[0])))) as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    assert max(picture.size) == 512
    fill = np.array([0xC9, 0xCE, 0xD6])
    assert (np.abs(pixels - fill).max(axis=2) <= 1).mean() > 0.4
    assert np.ptp(pixels, axis=2).max() <= 16  # greys alone
