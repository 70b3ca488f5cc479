"""The solved model as JSON, a stable contract: `docs/model.schema.json`, described in `docs/json.md`.

Numbers carry 12 significant digits; the same program gives the same bytes.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import rounded
from aidl_lang.common.render.terminal import to_dict as diagnostic_dict
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import Span
from aidl_lang.export.job import Exported, Job
from aidl_lang.geometry.boolean import Contact
from aidl_lang.geometry.curves import KINDS
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.region import Loop, Measures, Region
from aidl_lang.geometry.solved import Box, Mobility, SolvedGeometry, SolvedModel, SolvedStructure, described

VERSION = 1
_NUMBERS = re.compile(r"\[\n\s*[-+.\deE]+(?:,\n\s*[-+.\deE]+)*\n\s*\]")
_POLYGONS = re.compile(r'(?<="coordinates": )\d+')
_FINISHES = {"fillet": ("radius",), "chamfer": ("size", "second")}
"""Names of the sizes of finished corners."""
Json = dict[str, Any]

TOLERANCE = 1e-3
"""Largest distance of the polygons of regions from their outlines, relative to the size of the drawing."""


def to_json(job: Job) -> Exported:
    """Writes the document with one member per line, lists of numbers and polygons in one line."""
    document = to_dict(job.model, job.drawing, job.diagnostics(), job.options.timings)
    polygons = []
    for number, region in enumerate(document["regions"].values()):  # each has its number for a while
        polygons.append(json.dumps(region["geometry"]["coordinates"]))
        region["geometry"]["coordinates"] = number
    text = json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False)
    # JSON strings hold no line breaks and no quotes, so these patterns are never inside one.
    text = _NUMBERS.sub(lambda match: "".join(match[0].split()).replace(",", ", "), text)
    text = _POLYGONS.sub(lambda match: polygons[int(match[0])], text)
    return Exported(f"{text}\n".encode())


def to_dict(
    model: SolvedModel,
    drawing: Drawing,
    diagnostics: Iterable[Diagnostic] = (),
    timings: Mapping[str, float] | None = None,
) -> Json:
    """Returns the document as plain dicts and lists, its numbers rounded."""
    tolerance = TOLERANCE * drawing.size
    document: Json = {
        "aidl": VERSION,
        "units": "mm",
        "status": model.status,
        "root": _structure(model.root, model.mobility()),
        "constraints": [
            {"path": c.path, "text": c.text, **_place(c.span)}
            | {"residual": c.residual, "satisfied": c.satisfied}
            | ({"soft": True} if c.soft else {})
            for c in model.constraints
        ],
        "dof": model.degrees,
        "free": model.mobility().free,
        "motions": [
            {"kind": m.kind, "things": m.things, "words": m.words, "moves": m.moves}
            | ({"against": m.against} if m.against else {})
            for m in model.motions
        ],
        "changed": [
            {"path": c.path, "written": c.written, "solved": c.solved, "because": c.because}
            for c in model.changed
        ],
        "tolerance": tolerance,
        "bodies": [body.path for body in drawing.bodies],
        "regions": {
            path: _region(drawing.regions[path], m, tolerance) for path, m in drawing.measures.items()
        },
        "pairs": [*map(contact, drawing.pairs)],
        "diagnostics": [diagnostic_dict(d) for d in diagnostics],
    }
    if model.readings:
        document["readings"] = [
            {"text": r.span.one_line, **_place(r.span), "reading": r.text} for r in model.readings
        ]
    if timings is not None:
        document["timings"] = timings
    result: Json = rounded(document)
    return result


def _place(span: Span) -> Json:
    return {"line": span.line, "column": span.column}


def _structure(s: SolvedStructure, mobility: Mobility) -> Json:
    frame: Json = {"x": float(s.frame.x), "y": float(s.frame.y), "rotation": float(s.frame.rotation)}
    if s.frame.mirrored:
        frame["mirrored"] = True
    entry: Json = {
        "name": s.name,
        "path": s.path,
        "kind": s.kind,
        "orientation": s.orientation,
        "frame": frame,
        "bb": None if s.box is None else _box(s.box),
        "params": s.params,
        "geometry": {g.name: _geometry(g) for g in s.geometry},
        "structures": [_structure(c, mobility) for c in s.structures],
        **dict(zip(("dof", "constrained"), mobility.of(s), strict=True)),
    }
    if attributes := {name: values for name, values in s.attributes.items() if name != "orientation"}:
        entry["attributes"] = attributes
    if s.finishes:
        entry["finishes"] = [
            {"kind": f.kind, "at": at} | dict(zip(_FINISHES[f.kind], f.sizes, strict=False))
            for f in s.finishes
            for at in f.corners
        ]
    if s.is_empty:
        entry["empty"] = True
    if s.doc:
        entry["doc"] = s.doc
    return entry


def _box(box: Box) -> Json:
    return {"left": box.left, "right": box.right, "top": box.top, "bottom": box.bottom}


def _region(region: Region, measures: Measures, tolerance: float) -> Json:
    """Returns measures, exact outlines, and polygons of them in the form of RFC 7946 (GeoJSON)."""
    return {
        "area": measures.area,
        "perimeter": measures.perimeter,
        "loops": measures.loops,
        "centroid": measures.centroid,
        "bb": _box(Box(*measures.box)),
        "faces": [
            {"outer": _pieces(face.outer), "holes": [_pieces(hole) for hole in face.holes]}
            for face in region.faces
        ],
        "geometry": {
            "type": "MultiPolygon",
            "coordinates": [
                [[*ring, ring[0]] for ring in (p.tolist() for p in face.polygons(tolerance))]
                for face in region.faces
            ],
        },
    }


def _pieces(loop: Loop) -> list[Json]:
    return [{"type": kind} | values for kind, values in map(described, loop.pieces)]


def _geometry(g: SolvedGeometry) -> Json:
    """Returns a point or a curve with its numbers, anything else with its parts."""
    checkpoint()
    entry: Json = {"type": g.type}
    if g.type in KINDS or g.type == "point":
        entry |= g.values
    else:
        entry["params"] = g.values
        entry["parts"] = {part.name: _geometry(part) for part in g.parts}
    if g.construction:
        entry["construction"] = True
    if g.attributes:
        entry["attributes"] = g.attributes
    return entry


def contact(pair: Contact, fields: Iterable[str] = ("a", "b", "relation", "gap", "area")) -> Json:
    """Returns the fields that a contact has."""
    return {name: value for name in fields if (value := getattr(pair, name)) is not None}
