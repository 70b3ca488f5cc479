"""The peers that are Python packages, or bound to Python.

Each is given the form of a constraint that suits it best. What a sketch leaves open is read from the first
guess, where a peer wants to be told.
"""

from __future__ import annotations

from benchmarks.solver.contestant import Contestant
from benchmarks.solver.peers.least_squares import ScipyDense, ScipySparse
from benchmarks.solver.peers.planegcs import PlaneGCS
from benchmarks.solver.peers.solvespace import PythonSolveSpace, Slvs

PEERS: dict[str, type[Contestant]] = {
    "planegcs": PlaneGCS,
    "python-solvespace": PythonSolveSpace,
    "slvs": Slvs,
    "scipy": ScipyDense,
    "scipy-sparse": ScipySparse,
}
