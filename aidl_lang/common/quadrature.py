"""Gauss-Legendre quadrature."""

from __future__ import annotations

from functools import lru_cache


@lru_cache(maxsize=8)
def gauss(count: int) -> tuple[tuple[float, float], ...]:
    """Returns nodes and weights over 0..1."""
    import numpy as np

    nodes, weights = np.polynomial.legendre.leggauss(count)
    return tuple((float(x + 1) / 2, float(w) / 2) for x, w in zip(nodes, weights, strict=True))
