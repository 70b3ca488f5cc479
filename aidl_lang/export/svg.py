"""SVG: millimetres, y upwards, one group per structure, holes really cut, curves as curves."""

from __future__ import annotations

import io
from collections import defaultdict
from typing import Any

from aidl_lang.export import palette
from aidl_lang.export.marks import clean
from aidl_lang.export.numbers import fixed
from aidl_lang.export.overlay import Overlay, explain
from aidl_lang.export.paths import face_path, open_path
from aidl_lang.geometry.drawing import Body, Drawing, Seam, Stroke
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.solved import SolvedModel, SolvedStructure

MARGIN = 0.03
OUTLINE_WIDTH, SEAM_WIDTH, STROKE_WIDTH = 0.0025, 0.001, 0.003
"""Relative to the larger side of the picture."""


def to_svg(model: SolvedModel, drawing: Drawing, show: frozenset[str] = frozenset()) -> str:
    """The drawing as an SVG document; `show` adds layers that explain it (see `overlay`)."""
    import svgwrite  # takes longer to import than most drawings to draw

    box = _picture_box(model, drawing, show)
    size = max(box[2] - box[0], box[3] - box[1]) or 1.0
    overlay = explain(model, drawing, show, box, size)
    left, bottom, right, top = _grown(overlay.box, MARGIN * size)
    width, height = right - left, top - bottom
    document = svgwrite.Drawing(
        size=(f"{fixed(width)}mm", f"{fixed(height)}mm"),
        viewBox=f"{fixed(left)} {fixed(-top)} {fixed(width)} {fixed(height)}",
        debug=False,
    )
    for group in _groups(svgwrite, model, drawing, size):
        document.add(group)
    _draw_overlay(svgwrite, document, overlay)
    text = io.StringIO()
    document.write(text)
    # One element per line. Text is escaped, so this pattern stands between tags only.
    return text.getvalue().replace("><", ">\n<") + "\n"


def _picture_box(model: SolvedModel, drawing: Drawing, show: frozenset[str]) -> Bounds:
    """What must be in sight. The box of the root stands in for a drawing without curves."""
    boxes = []
    if drawing.bodies or drawing.strokes:
        boxes.append(drawing.box)
    if "plan" in show:
        boxes += [plan.box for plan in drawing.plans]
    if show and (root := model.root.box) is not None:
        boxes.append((root.left, root.bottom, root.right, root.top))
    if not boxes:
        root = model.root.box
        return (root.left, root.bottom, root.right, root.top) if root else (0.0, 0.0, 10.0, 10.0)
    lefts, bottoms, rights, tops = zip(*boxes, strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


def _grown(box: Bounds, by: float) -> Bounds:
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by


def _groups(svg: Any, model: SolvedModel, drawing: Drawing, size: float) -> list[Any]:
    """One group per structure in order of writing, drawings after all others so that they lie on top."""
    bodies = defaultdict(list)
    for index, body in enumerate(drawing.bodies):
        bodies[body.path].append((index, body))
    seams = defaultdict(list)
    for seam in drawing.seams:
        seams[seam.path].append(seam)
    strokes = defaultdict(list)
    for stroke in drawing.strokes:
        strokes[stroke.path].append(stroke)
    order = sorted(model.root.walk(), key=lambda s: s.kind == "drawing")
    groups = []
    for structure in order:
        group = svg.container.Group(**_identity(structure, drawing), debug=False)
        for index, body in bodies[structure.path]:
            _add_body(svg, group, body, index, size)
        for seam in seams[structure.path]:
            group.add(_seam(svg, seam, size))
        for stroke in strokes[structure.path]:
            group.add(_stroke(svg, stroke, size))
        groups.append(group)
    return groups


def _identity(structure: SolvedStructure, drawing: Drawing) -> dict[str, str]:
    """The attributes by which programs find a structure in the picture."""
    style = drawing.styles[structure.path]
    identity = {"id": structure.path, "data-kind": structure.kind, "data-path": structure.path}
    if style.layer is not None:
        identity["data-layer"] = style.layer
    return {key: clean(value) for key, value in identity.items()}


def _add_body(svg: Any, group: Any, body: Body, index: int, size: float) -> None:
    fill = body.style.color or palette.body_fill(index)
    for face in body.region.faces:
        group.add(
            svg.path.Path(
                d=face_path(face),
                fill=fill,
                fill_rule="evenodd",
                stroke=palette.OUTLINE,
                stroke_width=fixed(OUTLINE_WIDTH * size),
                stroke_linejoin="round",
                debug=False,
            )
        )


def _seam(svg: Any, seam: Seam, size: float) -> Any:
    return svg.path.Path(
        d=open_path(seam.pieces),
        class_="seam",
        fill="none",
        stroke=palette.SEAM,
        stroke_width=fixed(SEAM_WIDTH * size),
        stroke_opacity="0.55",
        debug=False,
    )


def _stroke(svg: Any, stroke: Stroke, size: float) -> Any:
    ink = stroke.style.color or palette.OUTLINE
    extra = {}
    if stroke.role != "drawing":
        ink = palette.LOOSE
        extra = {"stroke_dasharray": f"{fixed(0.012 * size)} {fixed(0.008 * size)}", "class_": stroke.role}
    return svg.path.Path(
        d=open_path(stroke.pieces),
        fill="none",
        stroke=ink,
        stroke_width=fixed(STROKE_WIDTH * size),
        stroke_linecap="round",
        stroke_linejoin="round",
        debug=False,
        **extra,
    )


def _draw_overlay(svg: Any, document: Any, overlay: Overlay) -> None:
    """The layers of the overlay, each a group of its own."""
    for name, marks in overlay.layers.items():
        group = svg.container.Group(id=f"show-{name}", class_="overlay", debug=False)
        for mark in marks:
            group.add(mark.element(svg))
        document.add(group)
