"""Comparison of two versions of a solved model: what moved, turned, grew, appeared and vanished.

Things are compared by their paths. What went as a whole is told once: a structure speaks for its parts that
went along, and a shape for its corners. Numbers are equal within 1e-6 of themselves, places within 1e-6 of
the size of the drawing.
"""

from aidl_lang.export.comparison.changes import (
    Comparison,
    ContactChange,
    GeometryChange,
    StructureChange,
    Version,
)
from aidl_lang.export.comparison.compare import compare

__all__ = ["Comparison", "ContactChange", "GeometryChange", "StructureChange", "Version", "compare"]
