"""A stand-in for the part of `manifold3d` that `aidl_lang` uses, over the npm package `manifold-3d`, for a
browser: the same kernel, compiled to WebAssembly. `start` puts it in the place of `manifold3d`.

A mesh has single precision here, as the package has no other; areas are as exact as those of `manifold3d`.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pyodide.ffi import JsException, to_js

kernel: Any = None
"""What `kernelOf` of `page/kernel.js` returns."""

Points = NDArray[np.float64]


class FillRule(enum.Enum):
    """Which parts of the plane polygons enclose."""

    EvenOdd = "EvenOdd"
    NonZero = "NonZero"
    Positive = "Positive"
    Negative = "Negative"


class JoinType(enum.Enum):
    """What corners become when an outline is offset."""

    Square = "Square"
    Round = "Round"
    Miter = "Miter"


class OpType(enum.Enum):
    """The booleans of several at once."""

    Add = "Add"


def _made(make: Callable[..., Any], *given: object) -> Any:
    try:
        return make(*given)
    except JsException as reason:
        raise RuntimeError(str(reason)) from None


class _Held:
    """A thing in the kernel's memory, which is freed with it."""

    def __init__(self, thing: Any) -> None:
        self._thing = thing

    @classmethod
    def _of(cls, thing: Any) -> Self:
        held = cls.__new__(cls)
        held._thing = thing
        return held

    def __del__(self) -> None:
        if (thing := getattr(self, "_thing", None)) is not None:
            thing.delete()

    def is_empty(self) -> bool:
        return bool(self._thing.isEmpty())

    def __sub__(self, other: Self) -> Self:
        return self._of(_made(self._thing.subtract, other._thing))

    def __add__(self, other: Self) -> Self:
        return self._of(_made(self._thing.add, other._thing))

    def __xor__(self, other: Self) -> Self:
        return self._of(_made(self._thing.intersect, other._thing))

    def translate(self, by: Sequence[float]) -> Self:
        return self._of(self._thing.translate(*map(float, by)))


class CrossSection(_Held):
    """An area of the plane bounded by polygons."""

    def __init__(
        self, polygons: Sequence[Points] | None = None, fillrule: FillRule = FillRule.Positive
    ) -> None:
        given = [np.asarray(polygon, np.float64) for polygon in polygons or ()]
        if any(each.ndim != 2 or each.shape[1] != 2 for each in given):
            raise TypeError("a polygon is an array of points, each of two numbers")
        if not given:
            super().__init__(kernel.nothing())
            return
        lengths = np.array([len(each) for each in given], np.int32)
        points = np.concatenate(given).ravel()
        super().__init__(_made(kernel.section, to_js(points), to_js(lengths), fillrule.value))

    @classmethod
    def square(cls, size: tuple[float, float]) -> CrossSection:
        return cls._of(kernel.square(float(size[0]), float(size[1])))

    @classmethod
    def batch_boolean(cls, sections: Sequence[CrossSection], op: OpType) -> CrossSection:
        assert op is OpType.Add
        return cls._of(_made(kernel.union, to_js([each._thing for each in sections])))

    def area(self) -> float:
        return float(self._thing.area())

    def bounds(self) -> tuple[float, float, float, float]:
        left, bottom, right, top = kernel.bounds(self._thing).to_py().tolist()
        return left, bottom, right, top

    def num_contour(self) -> int:
        return int(self._thing.numContour())

    def num_vert(self) -> int:
        return int(self._thing.numVert())

    def decompose(self) -> list[CrossSection]:
        return [self._of(each) for each in self._thing.decompose()]

    def to_polygons(self) -> list[Points]:
        points, lengths = kernel.outlines(self._thing)
        flat = np.array(points.to_py(), np.float64).reshape(-1, 2)
        ends = np.cumsum(np.array(lengths.to_py(), np.intp))
        return np.split(flat, ends[:-1]) if len(ends) else []

    def offset(self, delta: float, join: JoinType, miter_limit: float, segments: int) -> CrossSection:
        return self._of(_made(self._thing.offset, float(delta), join.value, float(miter_limit), segments))

    def simplify(self, epsilon: float) -> CrossSection:
        return self._of(self._thing.simplify(float(epsilon)))

    def extrude(self, height: float) -> Manifold:
        return Manifold._of(_made(self._thing.extrude, float(height)))


class Mesh64:
    """The triangles of a solid."""

    def __init__(self, points: Points, triangles: NDArray[np.uint64]) -> None:
        self.vert_properties, self.tri_verts = points, triangles


class Manifold(_Held):
    """A solid bounded by triangles."""

    @classmethod
    def cylinder(cls, height: float, low: float, high: float, sides: int) -> Manifold:
        return cls._of(_made(kernel.cylinder, float(height), float(low), float(high), sides))

    @classmethod
    def batch_boolean(cls, solids: Sequence[Manifold], op: OpType) -> Manifold:
        assert op is OpType.Add
        return cls._of(_made(kernel.joined, to_js([each._thing for each in solids])))

    @classmethod
    def compose(cls, solids: Sequence[Manifold]) -> Manifold:
        return cls._of(_made(kernel.composed, to_js([each._thing for each in solids])))

    def refine(self, n: int) -> Manifold:
        return self._of(_made(self._thing.refine, n))

    def to_mesh64(self) -> Mesh64:
        points, width, triangles = kernel.mesh(self._thing)
        flat = np.array(points.to_py(), np.float64).reshape(-1, int(width))
        return Mesh64(flat, np.array(triangles.to_py(), np.uint64).reshape(-1, 3))
