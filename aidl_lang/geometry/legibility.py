"""Strokes that cannot be seen, because what they lie on has their colour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from aidl_lang.diagnostics import Diagnostic
from aidl_lang.geometry.colors import look_alike
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.notes import listed
from aidl_lang.geometry.sections import Section, inside_mask
from aidl_lang.solved import SolvedStructure


@dataclass(frozen=True)
class Ground:
    """What strokes lie on: the bodies from back to front, each with its colour, if it has one."""

    network: Network
    bodies: Sequence[tuple[str | None, Section]]

    def hides(self, color: str | None, curves: Sequence[int]) -> list[bool]:
        """For each edge of some curves of the network whether it is not seen in a colour."""
        if color is None:
            return []
        alike = [fill is not None and look_alike(fill, color) for fill, _ in self.bodies]
        if not any(alike):
            return []
        edges = [edge for curve in curves for edge, _ in self.network.uses[curve]]
        hidden = np.zeros(len(edges), dtype=np.bool_)
        spots = [self.network.midpoint(edge) for edge in edges]
        for is_alike, (_, section) in zip(alike, self.bodies, strict=True):
            hidden[inside_mask(section, spots)] = is_alike
        return hidden.tolist()


def unseen_note(drawing: SolvedStructure, names: Sequence[str], color: str) -> Diagnostic:
    """For curves of a drawing that was given the colour of what they lie on."""
    return Diagnostic(
        "W0709",
        f"{listed(names)} of drawing `{drawing.path}` cannot be seen: {color} on what has that colour",
        drawing.span,
        "strokes of the colour of what is below",
        hints=(
            'give it another colour, as `@color("dimgray")`',
            "with no `@color` of its own it gets one that shows",
        ),
    )
