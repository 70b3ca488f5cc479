"""Writers, one file per format, behind one table from file suffix to writer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from aidl_lang.diagnostics import Diagnostic
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.solved import SolvedModel


@dataclass(frozen=True)
class Job:
    """What a writer may draw on.

    show     what explains the drawing on top of it: names, points, bbox, constraints, dof, plan
    timings  seconds per stage, for formats that carry them
    """

    model: SolvedModel
    drawing: Drawing
    diagnostics: tuple[Diagnostic, ...] = ()
    show: frozenset[str] = field(default_factory=frozenset)
    timings: Mapping[str, float] | None = None


Exporter = Callable[[Job], bytes]
SHOW = ("names", "points", "bbox", "constraints", "dof", "plan")


def _svg(job: Job) -> bytes:
    from aidl_lang.export.svg import to_svg

    return to_svg(job.model, job.drawing, job.show).encode()


def _json(job: Job) -> bytes:
    from aidl_lang.export.json import to_json

    return to_json(job.model, job.drawing, job.diagnostics, job.timings).encode()


EXPORTERS: dict[str, Exporter] = {".svg": _svg, ".json": _json}
