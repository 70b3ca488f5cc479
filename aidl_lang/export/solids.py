"""Common to the three-dimensional formats: bodies in their planes, with their thickness."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.common.records import record
from aidl_lang.export import ExportError, Job
from aidl_lang.geometry.drawing import Body, Stroke
from aidl_lang.geometry.evaluate import LARGEST
from aidl_lang.geometry.overhanging import owner
from aidl_lang.geometry.placement import GROUND, Plane, planes, thickness_of
from aidl_lang.geometry.region import Region

THINNEST = 1e-6
"""mm. A smaller thickness is lost among the tolerances of programs that read the file."""

_REMEDIES = ("say how thick: `@thickness(3mm)` before it or what is around it", "or for all: `--thickness 3`")
_NAMED = 6


@record()
class Recess:
    """An area that a hole which ends in its solid takes away of it, down from the face that is seen.

    plane      that of its bottom, `depth` mm below the face
    narrowing  how much less the radius of a circle is there, mm
    """

    region: Region
    plane: Plane
    depth: float
    narrowing: float = 0.0


@record()
class PlacedBody:
    """A body, its plane, its thickness in mm, None if it stays flat, and what is taken away of that."""

    body: Body
    plane: Plane
    thickness: float | None
    recesses: tuple[Recess, ...] = ()


def placed_bodies(job: Job) -> list[PlacedBody]:
    """Returns the bodies in order of drawing. Raises ExportError for one that cannot be made a solid."""
    stand = _planes(job)
    found = []
    for body in job.drawing.bodies:
        thickness = thickness_of(body, job.options.thickness)
        _require_size(body, thickness)
        _require_place(body.path, stand[body.path])
        recesses = _recesses(job, body, stand[body.path], thickness) if thickness is not None else ()
        found.append(PlacedBody(body, stand[body.path], thickness, tuple(recesses)))
    return found


def _recesses(job: Job, body: Body, plane: Plane, thickness: float) -> Iterator[Recess]:
    bodies, styles = {other.path: other for other in job.drawing.bodies}, job.drawing.styles
    grows_up = float(np.cross(plane.u, plane.v) @ plane.growth) > 0
    for path, region in job.drawing.regions.items():
        if not styles[path].is_blind or not _holds(bodies, path, body.path):
            continue
        depth, *taper = styles[path].depth
        slope = math.tan(math.radians(taper[0] / 2)) if taper else 0.0
        if (circle := region.circle) is None:
            slope = 0.0
        elif slope:  # no deeper than its point
            depth = min(depth, circle.radius / slope)
        bottom = plane.shifted(thickness - depth) if grows_up else plane
        yield Recess(region, bottom, depth, depth * slope)


def _holds(bodies: Mapping[str, Body], hole: str, body: str) -> bool:
    """Tells whether a hole takes away of a body: the one around it, or all in the assembly around it."""
    if (holder := owner(bodies, hole)) is not None:
        return holder == body
    while hole and not any(path.startswith(f"{hole}.") for path in bodies):
        hole = hole.rpartition(".")[0]
    return body.startswith(f"{hole}.")


def placed_strokes(job: Job) -> list[tuple[Stroke, Plane]]:
    """Returns the strokes with the planes they lie in, without the outlines of recesses."""
    stand = _planes(job)
    for stroke in job.drawing.strokes:
        _require_place(stroke.path, stand[stroke.path])
    solid = {path for path, style in job.drawing.styles.items() if style.is_blind}
    return [(stroke, stand[stroke.path]) for stroke in job.drawing.strokes if stroke.path not in solid]


def _planes(job: Job) -> dict[str, Plane]:
    if job.is_flat:
        return dict.fromkeys((s.path for s in job.model.root.walk()), GROUND)
    return planes(job.model.root)


def thick_bodies(job: Job) -> tuple[list[PlacedBody], tuple[Diagnostic, ...]]:
    """Returns the bodies that have a thickness, and a warning that names the others."""
    bodies = placed_bodies(job)
    thick = [p for p in bodies if p.thickness is not None]
    flat = [p.body.path for p in bodies if p.thickness is None]
    if not bodies:
        raise ExportError(
            "E0917", "there is no body to write", "material is what the curves of a `solid` enclose"
        )
    if not flat:
        return thick, ()
    have = f"{named(flat, _NAMED)} {'has' if len(flat) == 1 else 'have'} no thickness"
    if not thick:
        raise ExportError("E0917", have, *_REMEDIES)
    left_out = "is left out" if len(flat) == 1 else "are left out"
    return thick, (Diagnostic("W0725", f"{have} and {left_out}", hints=_REMEDIES),)


def _require_size(body: Body, thickness: float | None) -> None:
    if thickness is not None and not THINNEST <= thickness <= LARGEST:
        raise ExportError(
            "E0918",
            f"`{body.path}` cannot be made a solid: it would be {thickness:g} mm thick",
            f"a thickness is from {THINNEST:g} to {LARGEST:g} mm",
        )


def _require_place(path: str, plane: Plane) -> None:
    if not np.abs(plane.origin).max() <= LARGEST:
        raise ExportError(
            "E0918",
            f"`{path}` cannot be placed in space: it lies further out than {LARGEST:g} mm",
            "look for an `@elevation` that was written in another unit, or multiplied once too often",
        )
