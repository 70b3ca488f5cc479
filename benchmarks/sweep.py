"""Sweeps: seconds and memory of many variants, beside a loop, a cluster on this machine, and OpenSCAD.

    python benchmarks/sweep.py [--counts N,N] [--only NAME,NAME]

Prints Markdown. What is swept is `examples/finger_box.aidl`, each variant written as DXF. The loop calls
`aidl_lang.compile` one variant after the other, as one wrote it before there were sweeps. OpenSCAD draws
`benchmarks/finger_box.scad`, the same five panels without the letters, by `xargs -P2`, one process each.
Seconds are those of the clock and of the processors, all processes together; memory is the most that any one
process held.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

HERE = Path(__file__).parent
PROGRAM = HERE.parent / "examples" / "finger_box.aidl"
SCAD = HERE / "finger_box.scad"
_PORT = 18_791
_LOOP = """\
import sys
from pathlib import Path
import aidl_lang
for k in range(int(sys.argv[2])):
    length = 60 + 140 * k / max(1, int(sys.argv[2]) - 1)
    aidl_lang.compile(Path(sys.argv[1]), {"length": length}).save(f"out/{k}.dxf")
"""


def aidl(count: int, *more: str) -> list[str]:
    """Returns the command that sweeps so many variants."""
    words = [sys.executable, "-m", "aidl_lang", "sweep", str(PROGRAM), "-D", f"length=60..200/{count}"]
    return [*words, "-o", "out/{n}.dxf", "-o", "table.csv", *more]


def loop(count: int) -> list[str]:
    return [sys.executable, "-c", _LOOP, str(PROGRAM), str(count)]


def openscad(count: int) -> list[str]:
    lengths = "".join(f"{k} {60 + 140 * k / max(1, count - 1):.6f}\\n" for k in range(count))
    one = f"openscad -q -o out/$0.dxf -D length=$1 {SCAD}"
    return ["sh", "-c", f"printf '{lengths}' | xargs -P2 -n2 sh -c '{one}'"]


@contextmanager
def cluster(workers: int) -> Iterator[tuple[str, list[int]]]:
    """Yields the address of a scheduler on loopback with so many workers, and the sessions of all of them."""
    dask, address = str(Path(sys.executable).with_name("dask")), f"tcp://127.0.0.1:{_PORT}"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    own = ["--host", "127.0.0.1", "--no-dashboard"]
    begun = [subprocess.Popen([dask, "scheduler", *own, "--port", str(_PORT)], **quiet)]  # type: ignore[call-overload]
    for _ in range(workers):
        begun.append(subprocess.Popen([dask, "worker", address, *own, "--nthreads", "1"], **quiet))  # type: ignore[call-overload]
    try:
        time.sleep(10)
        yield address, [process.pid for process in begun]
    finally:
        for process in reversed(begun):
            os.killpg(process.pid, 15)
            process.wait()


class Watched:
    """The processes of some sessions: the processor time that all of them took, and the most memory that one
    and all of them had.
    """

    def __init__(self, sessions: set[int]) -> None:
        self.sessions = sessions
        self.largest = self.all_at_once = 0
        self._ticks: dict[int, int] = {}
        self._before: dict[int, int] = {}

    def look(self) -> None:
        together = 0
        for stat in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rpartition(")")[2].split()
            except OSError:
                continue  # it has ended
            if int(fields[3]) in self.sessions:
                pid, pages = int(stat.parent.name), int(fields[21])
                ticks = int(fields[11]) + int(fields[12])
                self._ticks[pid] = ticks - self._before.setdefault(pid, ticks if not self._ticks else 0)
                self.largest, together = max(self.largest, pages), together + pages
        self.all_at_once = max(self.all_at_once, together)

    @property
    def seconds(self) -> float:
        return sum(self._ticks.values()) / os.sysconf("SC_CLK_TCK")


def measured(name: str, count: int, command: list[str], sessions: Sequence[int] = ()) -> str:
    """Returns a row of the table; `sessions` are those of a cluster."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "out").mkdir()
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        with open(Path(folder, "said"), "w") as said:
            run = subprocess.Popen(command, cwd=folder, stdout=said, stderr=said, start_new_session=True)
        watched = Watched({run.pid, *sessions})
        while run.poll() is None:
            watched.look()
            time.sleep(0.1)
        seconds, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        made = len(list(Path(folder, "out").iterdir()))
        if run.returncode or made != count:
            raise SystemExit(
                f"{name}: {made} of {count} drawings\n{Path(folder, 'said').read_text()[-2000:]}"
            )
    waited = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    used, page = max(waited, watched.seconds), os.sysconf("SC_PAGE_SIZE")
    memory = f"{watched.largest * page >> 20} | {watched.all_at_once * page >> 20}"
    return f"| {name} | {count} | {seconds:.1f} | {used:.1f} | {1000 * used / count:.0f} | {memory} |"


def rows(counts: list[int], only: set[str]) -> Iterator[str]:
    """Yields the rows of the table, of each count those asked for."""
    for count in counts:
        for name, command in (
            ("loop", loop(count)),
            ("sweep", aidl(count, "--jobs", "2")),
            ("openscad", openscad(count)),
        ):
            if name in only:
                yield measured(name, count, command)
        if "cache" in only:
            with tempfile.TemporaryDirectory() as folder:
                measured("cache", count, [*aidl(count, "--jobs", "2"), "--cache", folder])
                yield measured("sweep, all known", count, [*aidl(count, "--jobs", "2"), "--cache", folder])
        for workers in (1, 2):
            if "cluster" in only:
                with cluster(workers) as (address, sessions):
                    yield measured(f"cluster of {workers}", count, aidl(count, "--on", address), sessions)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--counts", default="50,1000", help="default: 50,1000")
    parser.add_argument("--only", default="loop,sweep,cache,cluster,openscad")
    said = parser.parse_args()
    if shutil.which("openscad") is None:
        print("openscad is not installed, and left out", file=sys.stderr)
        said.only = said.only.replace("openscad", "")
    print(f"Load before: {os.getloadavg()[0]:.1f} on {len(os.sched_getaffinity(0))} processors\n")
    print("| | variants | seconds | processor, s | each, ms | largest process, MB | all, MB |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for row in rows([int(n) for n in said.counts.split(",")], set(said.only.split(","))):
        print(row, flush=True)


if __name__ == "__main__":
    main()
