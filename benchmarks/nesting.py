"""Sheets: how many parts take, packed by their boxes, by their outlines, and by others.

    python benchmarks/nesting.py [--seconds N] [--spacing MM]

Prints Markdown. The parts are those of the Raspberry Pi case, once and eight times, and 200 of several
shapes, on sheets of 600 × 400 mm. `taken` is the area of all sheets less what can be cut off the last one in
one piece, `used` the share of it that is material. Time is that of the clock, once: packing by outlines takes
the time that it is given, and some to begin. The others are further algorithms of rectpack, which turn boxes
by quarters too.
"""

from __future__ import annotations

import argparse
import math
import random
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

SHEET = (600.0, 400.0)
CASE = Path(__file__).resolve().parent.parent / "examples" / "workshop" / "pi_case.aidl"
SEED = 1
ALGORITHMS = {
    "rectpack, best short side": "MaxRectsBssf",
    "rectpack, best area": "MaxRectsBaf",
    "rectpack, skyline": "SkylineMwfWm",
    "rectpack, guillotine": "GuillotineBssfSas",
}


@dataclass(frozen=True)
class Result:
    sheets: int
    last: float
    """Area of the last sheet that is left when the largest strip beside or above all parts is cut off."""
    seconds: float

    @property
    def taken(self) -> float:
        return (self.sheets - 1) * SHEET[0] * SHEET[1] + self.last


def lost(right: float, top: float) -> float:
    return min(right * SHEET[1], top * SHEET[0])


@dataclass(frozen=True)
class Case:
    name: str
    program: str

    def compiled(self) -> Any:
        from aidl_lang import pipeline
        from aidl_lang.common.source import SourceFile

        found = pipeline.compile(SourceFile("parts.aidl", self.program))
        assert found.ok, found.diagnostics
        return found


def cases() -> Iterator[Case]:
    text = CASE.read_text("utf-8")
    yield Case("the case once, 6 parts", text)
    yield Case("the case eight times, 48 parts", text.replace("@thickness(", "@quantity(8) @thickness(", 1))
    yield Case("200 parts of six shapes", mixed(200))


def mixed(count: int) -> str:
    """A program with parts of six shapes in sizes between 20 and 90 mm."""
    r = random.Random(SEED)
    shapes = (
        "circle(radius: {a} / 2)",
        "l_shape(width: {a}, height: {b}, thickness: {c})",
        "triangle(base: {a}, height: {b})",
        "star(n: 5, outer_radius: {a} / 2, inner_radius: {a} / 4)",
        "slot(center: origin, length: {a} + {c}, width: {c})",
        "t_shape(width: {a}, height: {b}, thickness: {c})",
    )
    lines = []
    for k in range(count):
        a, b = r.randint(30, 90), r.randint(30, 90)
        shape = shapes[k % len(shapes)].format(a=a, b=b, c=r.randint(8, 14))
        lines.append(
            f"@detached solid p{k} at fixed(({200 * (k % 20)}, {200 * (k // 20)})) {{ g = {shape} }}"
        )
    return f'@material("birch") @thickness(3)\nassembly many {{\n{chr(10).join(lines)}\n}}\n'


def ours(compiled: Any, spacing: float, seconds: float | None) -> Result:
    from aidl_lang.geometry.sheets import laid_out

    start = time.perf_counter()
    layout = laid_out(compiled.drawing, SHEET, spacing, seconds)
    taken = time.perf_counter() - start
    boxes = [body.box for body in layout.sheets[-1].bodies]
    return Result(len(layout.sheets), lost(max(b[2] for b in boxes), max(b[3] for b in boxes)), taken)


def boxes(compiled: Any) -> list[tuple[float, float]]:
    from aidl_lang.geometry.parts import parts_of

    found, _ = parts_of(compiled.drawing)
    return [part.size for part in found for _ in range(part.body.style.quantity)]


def material(compiled: Any) -> float:

    areas = (body.region.area * body.style.quantity for body in compiled.drawing.bodies)
    return float(sum(areas))


def by_rectpack(sizes: Sequence[tuple[float, float]], spacing: float, algorithm: str) -> Result:
    from rectpack import PackingMode, newPacker

    start = time.perf_counter()
    # The newest bin is filled first, or any that has room, and each is opened when nothing else has any.
    packer = newPacker(mode=PackingMode.Offline, pack_algo=getattr(import_module("rectpack"), algorithm))
    packer.add_bin(*(round(1000 * (side - spacing)) for side in SHEET), count=math.inf)
    for width, height in sizes:
        packer.add_rect(*(math.ceil(1000 * (side + spacing)) for side in (width, height)))
    packer.pack()
    taken = time.perf_counter() - start
    bins = list(packer)
    assert sum(map(len, bins)) == len(sizes)
    ends = [((r.x + r.width) / 1000, (r.y + r.height) / 1000) for r in bins[-1]]
    return Result(len(bins), lost(max(x for x, _ in ends), max(y for _, y in ends)), taken)


def packers(compiled: Any, spacing: float, seconds: float) -> Iterator[tuple[str, Callable[[], Result]]]:
    sizes = boxes(compiled)
    yield "AIDL by boxes", lambda: ours(compiled, spacing, None)
    if find_spec("spyrrow"):
        yield f"AIDL by outlines, {seconds:g} s", lambda: ours(compiled, spacing, seconds)
    for name, algorithm in ALGORITHMS.items():
        yield name, lambda algorithm=algorithm: by_rectpack(sizes, spacing, algorithm)  # type: ignore[misc]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--spacing", type=float, default=3.0)
    arguments = parser.parse_args()
    for case in cases():
        compiled = case.compiled()
        total = material(compiled)
        print(f"\n{case.name}, {total / 1e2:.0f} cm² of material\n")
        print("| packer | sheets | taken, cm² | used | seconds |\n|---|--:|--:|--:|--:|")
        for name, pack in packers(compiled, arguments.spacing, arguments.seconds):
            found = pack()
            share = 100 * total / found.taken
            cells = [name, found.sheets, f"{found.taken / 100:.0f}", f"{share:.0f} %", f"{found.seconds:.1f}"]
            print(f"| {' | '.join(map(str, cells))} |", flush=True)


if __name__ == "__main__":
    main()
