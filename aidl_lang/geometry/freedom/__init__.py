"""The motions that are left, in words: those of the solver, taken apart into simple ones.

The solver tells for each part of the model which velocities are possible for what is drawn. Here simple
velocities are tried in turn (`telling`): of points, geometry, structures and of all that keeps together in
every motion, the smallest first, a slide along an axis or another direction, and a turn; then changes of
single parameters, then growth. Each that is possible and new is told; what is left over is told as things
that move together. That the whole drawing can move as one is known beforehand, so nothing is told of it.
`bending` follows each a little further, `relations` finds against what a thing moves, `wording` makes the
report.
"""

from __future__ import annotations

from aidl_lang.geometry.freedom.telling import motions
from aidl_lang.geometry.freedom.wording import report

__all__ = ["motions", "report"]
