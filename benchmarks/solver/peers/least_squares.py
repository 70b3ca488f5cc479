"""The peer SciPy: what one would write first."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, ClassVar

from benchmarks.solver.contestant import Contestant
from benchmarks.solver.sketch import Evaluator, Floats, Sketch


@dataclass
class _LeastSquares:
    evaluator: Evaluator
    start: Floats
    options: dict[str, Any]
    result: Floats | None = None


class ScipyDense(Contestant):
    """`scipy.optimize.least_squares` over the judge's own residuals, with finite differences."""

    is_sparse: ClassVar[bool] = False

    def __init__(self) -> None:
        self._optimize: Any = importlib.import_module("scipy.optimize")
        self._sparse: Any = importlib.import_module("scipy.sparse")
        ScipyDense.version = version("scipy")

    def build(self, sketch: Sketch) -> _LeastSquares:
        evaluator, options = Evaluator(sketch), dict.fromkeys(("xtol", "ftol", "gtol"), 1e-12)
        built = _LeastSquares(evaluator, sketch.start, dict(options))
        if self.is_sparse:
            rows, columns = evaluator.pattern
            shape = (evaluator.equations, sketch.unknowns)
            ones = ([1] * len(rows), (rows, columns))
            built.options["jac_sparsity"] = self._sparse.coo_matrix(ones, shape=shape).tocsr()
        return built

    def solve(self, built: _LeastSquares) -> str:
        found = self._optimize.least_squares(built.evaluator.residuals, built.start, **built.options)
        built.result = found.x
        return str(found.message)

    def read(self, built: _LeastSquares) -> list[float]:
        assert built.result is not None
        values: list[float] = built.result.tolist()
        return values


class ScipySparse(ScipyDense):
    """The same, told where the Jacobian is zero."""

    is_sparse = True
