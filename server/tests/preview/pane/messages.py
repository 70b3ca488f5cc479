"""A picture as a host sends it, of a plate of 100 × 60 mm with a hole of 20 mm in it."""

from __future__ import annotations

import itertools
from typing import Any

URI = "file:///home/you/plate.aidl"
TEXT = """drawing part {
    param width = 100 in 60..200
    solid plate {
        outline = rectangle(center: origin, width: width, height: 60)
        hole bore {
            rim = circle(center: (20, 5), radius: 10)
        }
    }
}
"""
SVG = """<?xml version="1.0" encoding="utf-8" ?>
<svg xmlns="http://www.w3.org/2000/svg" viewBox="-50 -30 100 60" width="100mm" height="60mm">
<g id="part" data-element="0" />
<g id="part.plate" data-element="1">
<path id="body" d="M-50 30L50 30L50 -30L-50 -30ZM30 -5A10 10 0 0 0 10 -5A10 10 0 0 0 30 -5Z" fill="#a7bcd6"
 fill-rule="evenodd" stroke="#2f3b4a" stroke-width="0.4" />
</g>
<path class="hit" data-element="2" d="M-50 30L50 30L50 -30L-50 -30Z" />
<path class="hit area" data-element="3" d="M30 -5A10 10 0 0 0 10 -5A10 10 0 0 0 30 -5Z" />
<path class="hit" data-element="4" d="M30 -5A10 10 0 0 0 10 -5A10 10 0 0 0 30 -5Z" />
</svg>
"""
PLATE, OUTLINE, BORE, RIM = 1, 2, 3, 4

_versions = itertools.count(1)


def place(line: int, start: int, end: int, last: int | None = None) -> dict[str, Any]:
    """A range from a line to the same or a last one."""
    first = {"line": line, "character": start}
    return {"start": first, "end": {"line": line if last is None else last, "character": end}}


def element(path: str, kind: str, type: str, range: object, hint: str) -> dict[str, Any]:
    return {"path": path, "kind": kind, "type": type, "range": range, "uri": range and URI, "hint": hint}


def knob(**changes: Any) -> dict[str, Any]:
    """A param `width` of 100 mm from 60 to 200, or another."""
    return {
        "path": "width",
        "name": "width",
        "kind": "number",
        "value": 100,
        "unit": "mm",
        "low": 60,
        "high": 200,
        "step": None,
        "choices": [],
        "doc": "How wide it is.",
        "range": place(1, 18, 21),
        "uri": URI,
        "editable": True,
        **changes,
    }


def handle(**changes: Any) -> dict[str, Any]:
    """The center of the hole, or another point."""
    path = "part.plate.bore.rim.center"
    return {"id": "h0", "path": path, "at": [20, 5], "moves": "guess", "hint": "center of rim", **changes}


def problem(**changes: Any) -> dict[str, Any]:
    return {
        "severity": "error",
        "code": "E0601",
        "message": "`bore` is not where it should be",
        "hints": ["move it"],
        "range": place(5, 18, 40),
        "uri": URI,
        "elements": [],
        "points": [],
        "fixes": 0,
        **changes,
    }


def picture(**changes: Any) -> dict[str, Any]:
    """A picture, with some of it as a test wants it. Each has a version of its own."""
    return {
        "uri": URI,
        "version": next(_versions),
        "status": "solved",
        "stale": False,
        "seconds": 0.0312,
        "svg": SVG,
        "box": [-50, -30, 50, 30],
        "elements": [
            element("part", "structure", "drawing", place(0, 0, 1, 8), "drawing"),
            element("part.plate", "structure", "solid", place(2, 4, 5, 7), "solid, 100 × 60 mm"),
            element("part.plate.outline", "geometry", "rectangle", place(3, 8, 69), "rectangle, 100 × 60 mm"),
            element("part.plate.bore", "structure", "hole", place(4, 8, 9, 6), "hole"),
            element("part.plate.bore.rim", "geometry", "circle", place(5, 12, 53), "circle, radius 10 mm"),
        ],
        "knobs": [knob()],
        "handles": [handle()],
        "problems": [],
        "conflicts": [],
        "motions": [],
        "degrees": 2,
        **changes,
    }


def where(number: int) -> dict[str, Any]:
    """Where an element of the plate is written."""
    found = picture()["elements"][number]
    return {"uri": found["uri"], "range": found["range"]}


def words(text: str | None = TEXT, **changes: Any) -> dict[str, Any]:
    """What a host tells of the text."""
    state = {"version": 1, "saved": True, "contested": False, "undo": None, "redo": None}
    return {**state, "text": text, **changes}


EXPORTS = {
    "formats": [{"name": "svg", "label": "SVG drawing"}, {"name": "dxf", "label": "DXF for cutters"}],
    "options": [
        {"name": "sheet", "label": "Sheet", "hint": "600x400", "choices": [], "formats": ["svg", "dxf"]},
        {
            "name": "nest",
            "label": "Packed by",
            "hint": "boxes",
            "choices": ["boxes", "outlines"],
            "formats": ["dxf"],
        },
    ],
}
