"""Regions: a plate with thousands of circles cut out, by AIDL and by others.

    python benchmarks/regions.py [--runs N] [--limit SECONDS] [--sizes N,N]

Prints Markdown. Every figure comes from a process of its own, which does the work once to warm up and then
several times. Time is processor time, the median of the runs; memory is the most that this process held. Who
works on polygons is given the chords that AIDL's booleans work on.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import Any

Circles = list[tuple[float, float, float]]
Result = tuple[float, int | None]
"""Area, and how many arcs and circles the outlines have; None if they have none."""

PITCH = 10.0


@dataclass(frozen=True)
class Plate:
    """A square from the origin, and the circles cut out of it: in rows, or at random and often crossing."""

    side: float
    circles: Circles
    exact: float | None

    @staticmethod
    def of(kind: str, count: int) -> Plate:
        row = math.ceil(math.sqrt(count))
        side = PITCH * (row + 1)
        if kind == "rows":
            spots = [(PITCH * (k % row + 1), PITCH * (k // row + 1), 4.0) for k in range(count)]
            return Plate(side, spots, side**2 - count * math.pi * 16)
        r = random.Random(1)
        spots = [(r.uniform(5, side - 5), r.uniform(5, side - 5), r.uniform(2, 5)) for _ in range(count)]
        return Plate(side, spots, None)

    @property
    def corners(self) -> list[tuple[float, float]]:
        return [(0, 0), (self.side, 0), (self.side, self.side), (0, self.side)]

    def polygons(self) -> list[Any]:
        """The circles as polygons with the chords that AIDL cuts them into."""
        import numpy as np

        from aidl_lang.geometry.network import CHORD

        result = []
        for x, y, r in self.circles:
            step = min(math.tau / 32, 2 * math.acos(1 - CHORD * self.side / r))
            u = np.arange(math.ceil(math.tau / step)) * (math.tau / math.ceil(math.tau / step))
            result.append(np.stack((x + r * np.cos(u), y + r * np.sin(u)), axis=1))
        return result


def ours(plate: Plate) -> Callable[[], Result]:
    from aidl_lang.geometry.curves import Circle, Line, Piece
    from aidl_lang.geometry.drawing import draw
    from aidl_lang.geometry.solved import Frame, SolvedGeometry, SolvedModel, SolvedStructure

    def geometry(name: str, curve: Piece | None, *parts: SolvedGeometry) -> SolvedGeometry:
        return SolvedGeometry(name, f"plate.{name}", "curve", {}, curve, parts, False, None)

    def structure(
        name: str, kind: str, own: list[SolvedGeometry], *below: SolvedStructure
    ) -> SolvedStructure:
        frame = Frame(0, 0, 0)
        return SolvedStructure(name, name, kind, "top", frame, {}, {}, tuple(own), below, None, False, None)

    corners = plate.corners
    sides = [Line(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    body = geometry("body", None, *(geometry(f"body{k}", side) for k, side in enumerate(sides)))
    rims = [geometry(f"rim{k}", Circle((x, y), r)) for k, (x, y, r) in enumerate(plate.circles)]
    root = structure("plate", "solid", [body], structure("plate.h", "hole", rims))
    model = SolvedModel("solved", root)

    def work() -> Result:
        region = draw(model)[0].regions["plate"]
        return region.area, sum(not isinstance(p, Line) for loop in region.loops for p in loop.pieces)

    return work


def manifold(plate: Plate) -> Callable[[], Result]:
    m: Any = import_module("manifold3d")

    polygons = plate.polygons()

    def work() -> Result:
        circles = m.CrossSection.batch_boolean([m.CrossSection([p]) for p in polygons], m.OpType.Add)
        return float((m.CrossSection([plate.corners]) - circles).area()), None

    return work


def geos(plate: Plate) -> Callable[[], Result]:
    import shapely

    polygons = plate.polygons()

    def work() -> Result:
        circles = shapely.unary_union(shapely.polygons([shapely.linearrings(p) for p in polygons]))
        return float(shapely.Polygon(plate.corners).difference(circles).area), None

    return work


def opencascade(plate: Plate) -> Callable[[], Result]:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.BRepGProp import BRepGProp
    from OCP.collections import List_TopoDS_Shape
    from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt
    from OCP.GProp import GProp_GProps
    from OCP.TopAbs import TopAbs_EDGE
    from OCP.TopExp import TopExp_Explorer

    def work() -> Result:
        body = BRepBuilderAPI_MakeFace(gp_Pln(), 0, plate.side, 0, plate.side).Face()
        cut = BRepAlgoAPI_Cut()
        shapes, tools = List_TopoDS_Shape(), List_TopoDS_Shape()
        shapes.Append(body)
        for x, y, r in plate.circles:
            circle = gp_Circ(gp_Ax2(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1)), r)
            wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire()
            tools.Append(BRepBuilderAPI_MakeFace(wire).Face())
        cut.SetArguments(shapes)
        cut.SetTools(tools)
        cut.Build()
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(cut.Shape(), properties)
        edges, explorer = 0, TopExp_Explorer(cut.Shape(), TopAbs_EDGE)
        while explorer.More():
            edges += 1
            explorer.Next()
        return float(properties.Mass()), edges - 4

    return work


def openscad(plate: Plate) -> Callable[[], Result]:
    """The command from a program to an SVG file; area is read back from the polygons it wrote."""
    fragments = 32

    def work() -> Result:
        with tempfile.TemporaryDirectory() as folder:
            program, picture = Path(folder) / "plate.scad", Path(folder) / "plate.svg"
            circles = "\n".join(
                f"translate([{x!r}, {y!r}]) circle(r = {r!r}, $fn = {fragments});"
                for x, y, r in plate.circles
            )
            text = f"difference() {{\nsquare({plate.side!r});\nunion() {{\n{circles}\n}}\n}}\n"
            program.write_text(text, encoding="utf-8")
            subprocess.run(["openscad", "-o", picture, program], check=True, capture_output=True)
            return _area_of_path(picture.read_text(encoding="utf-8")), None

    return work


def _area_of_path(svg: str) -> float:
    total = 0.0
    for part in svg.partition(' d="')[2].partition('"')[0].split("M ")[1:]:
        spots = [tuple(map(float, p.split(","))) for p in part.replace("z", "").split(" L ") if p.strip()]
        total += sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(spots, spots[1:] + spots[:1], strict=True)) / 2
    return abs(total)


CONTESTANTS: dict[str, tuple[str, Callable[[Plate], Callable[[], Result]]]] = {
    "ours": ("**AIDL**, regions stage", ours),
    "manifold": ("Manifold, polygons", manifold),
    "geos": ("Shapely (GEOS), polygons", geos),
    "openscad": ("OpenSCAD, to SVG", openscad),
    "opencascade": ("OpenCascade, exact", opencascade),
}


def measure(name: str, kind: str, count: int, runs: int) -> None:
    """The child: prints what it measured as JSON."""
    plate = Plate.of(kind, count)
    work = CONTESTANTS[name][1](plate)
    start = processor_time()
    area, arcs = work()
    first = processor_time() - start
    times = []
    for _ in range(runs if first < 5 else 1 if first < 30 else 0):
        start = processor_time()
        work()
        times.append(processor_time() - start)
    who = resource.RUSAGE_CHILDREN if name == "openscad" else resource.RUSAGE_SELF
    peak = resource.getrusage(who).ru_maxrss / (1024 if sys.platform != "darwin" else 1024**2)
    error = None if plate.exact is None else abs(area / plate.exact - 1)
    seconds = median(times) if times else first
    print(json.dumps({"seconds": seconds, "mb": peak, "error": error, "arcs": arcs}))


def processor_time() -> float:
    """Of this process and the commands it called, in seconds."""
    mine, called = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return mine.ru_utime + mine.ru_stime + called.ru_utime + called.ru_stime


def row(name: str, kind: str, count: int, runs: int, limit: float) -> dict[str, Any] | str:
    """What a child measured, or why there is nothing."""
    if name == "openscad" and shutil.which("openscad") is None:
        return "not installed"
    command = [sys.executable, __file__, "--child", name, kind, str(count), "--runs", str(runs)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return f"> {limit:g} s"
    if done.returncode:
        return "not installed" if "ModuleNotFoundError" in done.stderr else "failed"
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def table(kind: str, count: int, runs: int, limit: float) -> None:
    print(f"| {kind}, {count} circles | time | to AIDL | memory | error of area | arcs |")
    print("|---|--:|--:|--:|--:|--:|")
    base: float | None = None
    for name, (title, _) in CONTESTANTS.items():
        found = row(name, kind, count, runs, limit)
        if isinstance(found, str):
            print(f"| {title} | {found} | | | | |", flush=True)
            continue
        base = found["seconds"] if base is None else base
        error = "–" if found["error"] is None else f"{found['error']:.0e}"
        arcs = "none" if found["arcs"] is None else found["arcs"]
        print(
            f"| {title} | {1000 * found['seconds']:.0f} ms | {found['seconds'] / base:.2g} "
            f"| {found['mb']:.0f} MB | {error} | {arcs} |",
            flush=True,
        )
    print()


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure regions beside other libraries.")
    parser.add_argument("--runs", type=int, default=5, help="runs after a warm-up (default 5)")
    parser.add_argument("--limit", type=float, default=300, help="seconds for a child (default 300)")
    parser.add_argument("--sizes", default="1000,10000", help="how many circles (default 1000,10000)")
    parser.add_argument("--child", nargs=3, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        name, kind, count = arguments.child
        measure(name, kind, int(count), arguments.runs)
        return
    for kind in ("rows", "random"):
        for count in map(int, arguments.sizes.split(",")):
            table(kind, count, arguments.runs, arguments.limit)


if __name__ == "__main__":
    main()
