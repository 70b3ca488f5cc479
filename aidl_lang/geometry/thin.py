"""Finds walls that are thinner than their material allows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.materials import least_wall
from aidl_lang.common.prose import short
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.geometry.walls import thin_wall


def thin_wall_notes(
    root: SolvedStructure, bodies: Sequence[tuple[str, Region, str | None]]
) -> Iterator[Diagnostic]:
    """Yields a warning for each body, with its region and material, that is somewhere too thin."""
    spans = {s.path: s.span for s in root.walk()}
    for path, region, material in bodies:
        least = least_wall(material) if material and region else None
        wall = thin_wall(region, least) if least is not None else None
        if wall is None or least is None:
            continue
        x, y = ((a + b) / 2 for a, b in zip(wall.a, wall.b, strict=True))
        yield Diagnostic(
            "W0715",
            f"`{path}` is {short(wall.length, 3)} mm wide at ({short(x, 3)}, {short(y, 3)}), and walls of "
            f"{material} hold from {short(least)} mm",
            spans.get(path),
            "too thin there",
            hints=("`aidl measure` shows the thinnest wall of each part",),
        )
