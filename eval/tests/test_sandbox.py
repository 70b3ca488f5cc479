"""Programs in Python: what is kept from them, each guard by a program that tries it, and what they draw.

Most run beside a module of Python itself in place of a library; shapes are made up by the programs. What the
audit hook refuses is tried past it as well, so that the guards below it are tested by themselves.
"""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from aidl_eval import rendering, sandboxed
from aidl_eval.python_cad import PythonCad
from aidl_eval.rendering import Rendered
from aidl_eval.sandbox import fence
from tests.documents import ROOT

FAKE = PythonCad("statistics")
SANDBOX = Path(sandboxed.__file__).parent / "sandbox"
pytestmark = pytest.mark.skipif(FAKE.missing() is not None, reason=str(FAKE.missing()))

SHAPES = """
class Vector:
    def __init__(self, x, y, z=0.0): self.x, self.y, self.z = x, y, z
class Edge:
    wrapped, geom_type = None, "LINE"
    def __init__(self, a, b): self.a, self.b = a, b
    def position_at(self, t): return Vector(*(p + t * (q - p) for p, q in zip(self.a, self.b)))
class Wire:
    def __init__(self, *points): self.points = points
    def edges(self): return [Edge(a, b) for a, b in zip(self.points, self.points[1:] + self.points[:1])]
class Face:
    wrapped = None
    def __init__(self, outer, *inner): self.outer, self.inner = outer, inner
    def faces(self): return [self]
    def solids(self): return []
    def edges(self): return self.outer.edges()
    def outer_wire(self): return self.outer
    def inner_wires(self): return self.inner
def box(x, y, w, h): return Wire((x, y), (x + w, y), (x + w, y + h), (x, y + h))
"""


def run(program: str, seconds: float = 20) -> Rendered:
    (rendered,) = sandboxed.run(FAKE.name, [program], seconds)
    return rendered


def refused(program: str) -> str:
    rendered = run(program)
    assert len(rendered.errors) == 1
    return rendered.errors[0]


NOT_ALLOWED = "is not allowed: no files, no network, no other processes"
UNBOUNDED = "error: a coordinate is not a finite number, or too large"

WRONG = {
    "import statistics\nopen('/etc/passwd')": f"error (line 2): PermissionError: `open` {NOT_ALLOWED}",
    "import os\nos.listdir('/')": f"error (line 2): PermissionError: `os.listdir` {NOT_ALLOWED}",
    "import socket": "error (line 1): ImportError: `socket` cannot be imported here; there are ",
    "__import__('subprocess')": "error (line 1): ImportError: `subprocess` cannot be imported here",
    "x = 1 / 0": "error (line 1): ZeroDivisionError: division by zero",
    "x = (": "error (line 1): SyntaxError: '(' was never closed",
    "raise SystemExit(0)": "error (line 1): SystemExit: 0",
    "def f(): f()\nf()": "error (line 1): RecursionError: maximum recursion depth exceeded",
    "x = 3": "error: nothing is drawn: hand it to `show_object(…)`",
    "show_object(3)": "error: `int` cannot be shown: show faces, sketches or lists of them",
    f"{SHAPES}show_object(Face(Wire((0, 0, 0), (9, 0, 0), (9, 0, 5), (0, 0, 5))))": (
        "error: the drawing must lie in the plane"
    ),
    f"{SHAPES}show_object(Face(box(0, 0, float('nan'), 1)))": "error: a coordinate is not a finite number",
    f"{SHAPES}show_object(Face(box(0, 0, 1e300, 1)))": UNBOUNDED,
}


def test_a_program_is_told_what_is_wrong() -> None:
    for rendered, error in zip(sandboxed.run(FAKE.name, [*WRONG], 20), WRONG.values(), strict=True):
        assert [told[: len(error)] for told in rendered.errors] == [error]


HOSTILE = {
    "socket": "import sys\nsocket = sys.modules['_socket'].socket()",
    "file": "import sys\nsys.modules['posix'].open('/etc/passwd', 0)",
    "fork": "import sys\nsys.modules['posix'].fork()",
    "remove": "import sys\nsys.modules['posix'].remove('{victim}')",
    "kill": "import sys\nsys.modules['posix'].kill({pid}, 9)",
    "exec": "import sys\nsys.modules['posix'].execv('/bin/true', ['true'])",
}


def test_what_reaches_out_is_refused(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("here")
    tried = [program.format(victim=victim, pid=os.getpid()) for program in HOSTILE.values()]
    for name, rendered in zip(HOSTILE, sandboxed.run(FAKE.name, tried, 20), strict=True):
        (error,) = rendered.errors
        assert error.startswith(("error (line 2): PermissionError", "error (line 2): KeyError")), name
    assert victim.exists()


LIMITED = {
    "hungry": "held = bytearray(1 << 40)",
    "endless": "while True: pass",
    "deep": "def f(): f()\nf()",
    "many": "shape = {shape}\nshow_object([shape] * 5000)",
    "solid": "show_object({solid})",
    "library's own files": "{export}",
}


@pytest.mark.parametrize(
    ("library", "words"),
    [
        (
            "build123d",
            {
                "shape": "Rectangle(1, 1)",
                "solid": "Box(1, 1, 1)",
                "export": "export_step(Box(1, 1, 1), '{new}')",
            },
        ),
        (
            "cadquery",
            {
                "shape": "cq.Sketch().rect(1, 1)",
                "solid": "cq.Workplane().box(1, 1, 1)",
                "export": "cq.exporters.export(cq.Workplane().box(1, 1, 1), '{new}')",
            },
        ),
    ],
)
def test_the_libraries_themselves_reach_nothing(
    library: str, words: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if reason := PythonCad(library).missing():
        pytest.skip(reason)
    victim, new = tmp_path / "victim", tmp_path / "new.step"
    victim.write_text("here")
    head = {"build123d": "from build123d import *\n", "cadquery": "import cadquery as cq\n"}[library]
    words = {name: word.format(new=new) for name, word in words.items()}
    tried = {name: text.format(victim=victim, pid=os.getpid()) for name, text in HOSTILE.items()}
    tried |= {name: text.format(**words) for name, text in LIMITED.items()}
    found = dict(
        zip(tried, sandboxed.run(library, [head + text for text in tried.values()], 20), strict=True)
    )
    errors = {name: rendered.errors[0] for name, rendered in found.items()}
    assert not any(new.parent.glob("new*"))
    assert victim.read_text() == "here"
    for name in HOSTILE:
        assert re.match(r"error \(line [23]\): (PermissionError|KeyError)", errors[name]), errors
    assert errors["hungry"] == "error: the program took more than 4 GB of memory"
    assert errors["endless"] == "error: the program took longer than 20 s"
    assert "RecursionError" in errors["deep"]
    assert errors["many"] == "error: more than 4000 faces and lines are shown"
    assert errors["solid"].startswith("error: the drawing must be flat")
    assert errors["library's own files"].startswith("error")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="system calls are filtered on Linux")
def test_the_kernel_refuses_what_gets_past_the_hook(tmp_path: Path) -> None:
    """In a locked process without the audit hook nothing can be opened, started, removed or killed."""
    victim = tmp_path / "victim"
    victim.write_text("here")
    script = f"""
import os, socket, sys
sys.path.insert(0, {str(SANDBOX)!r})
import lock
alone = lock.leave_network()
sys.addaudithook = lambda hook: None
lock.lock(1 << 30, 10, 1 << 20)
tries = {{
    "open": lambda: os.open("/etc/passwd", os.O_RDONLY),
    "write": lambda: os.open({str(tmp_path / "new")!r}, os.O_WRONLY | os.O_CREAT),
    "socket": socket.socket,
    "fork": os.fork,
    "exec": lambda: os.execv("/bin/true", ["true"]),
    "remove": lambda: os.remove({str(victim)!r}),
    "kill": lambda: os.kill({os.getpid()}, 0),
    "pipe": os.pipe,
    "chmod": lambda: os.chmod({str(victim)!r}, 0),
}}
for name, attempt in tries.items():
    try:
        attempt()
        print(name, "done")
    except OSError as error:
        print(name, error.errno)
"""
    done = subprocess.run([sys.executable, "-I", "-c", script], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        f"{name} 1" for name in ["open", "write", "socket", "fork", "exec", "remove", "kill", "pipe", "chmod"]
    ]
    assert victim.read_text() == "here"


FENCED = """
import ctypes, os, socket, subprocess, sys, threading
from aidl_eval.sandbox import fence
fence.fence({folder!r})
def threaded():
    thread = threading.Thread(target=lambda: None)
    thread.start()
    thread.join()
tries = {{
    "thread": threaded,
    "own": lambda: open({folder!r} + "/new", "w").close(),
    "system": lambda: os.listdir("/usr"),
    "read": lambda: open({victim!r}),
    "list": lambda: os.listdir({outside!r}),
    "write": lambda: open({victim!r}, "w"),
    "new": lambda: open({outside!r} + "/new", "w"),
    "remove": lambda: os.remove({victim!r}),
    "passwd": lambda: open("/etc/passwd"),
    "process": lambda: open("/proc/self/environ"),
    "socket": socket.socket,
    "fork": os.fork,
    "spawn": lambda: subprocess.run(["/bin/true"]),
    "kill": lambda: os.kill({pid}, 0),
    "renumbered": lambda: fence._done(ctypes.CDLL(None, use_errno=True).syscall(0x40000029, 1, 1, 0)),
}}
for name, attempt in tries.items():
    try:
        attempt()
        print(name, "done")
    except OSError as error:
        print(name, error.errno)
"""


@pytest.mark.skipif(not fence.version(), reason="this kernel has no Landlock")
def test_a_fenced_process_has_the_system_and_one_folder(tmp_path: Path) -> None:
    folder, outside = tmp_path / "own", tmp_path / "outside"
    folder.mkdir()
    outside.mkdir()
    victim = outside / "victim"
    victim.write_text("here")
    said = {"folder": str(folder), "outside": str(outside), "victim": str(victim), "pid": os.getpid()}
    done = subprocess.run(
        [sys.executable, "-c", FENCED.format(**said)], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.stderr == ""
    refused = {"read": 13, "list": 13, "write": 13, "new": 13, "remove": 13, "passwd": 13, "process": 13}
    calls = dict.fromkeys(("socket", "fork", "spawn", "kill", "renumbered"), 1)
    expected = dict.fromkeys(("thread", "own", "system"), "done") | refused | calls
    assert dict(line.split() for line in done.stdout.splitlines()) == {k: str(v) for k, v in expected.items()}
    assert victim.read_text() == "here"


def test_a_process_leaves_the_network_where_the_system_allows_it() -> None:
    script = f"""
import sys
sys.path.insert(0, {str(SANDBOX)!r})
import lock, socket
print(lock.leave_network(), [name for _, name in socket.if_nameindex()])
"""
    done = subprocess.run([sys.executable, "-I", "-c", script], capture_output=True, text=True, check=False)
    outside = [name for _, name in socket.if_nameindex()]
    assert done.stdout.strip() in ("True ['lo']", f"False {outside}")


def test_what_does_not_end_is_ended() -> None:
    late = "error: the program took longer than 1 s"
    begun = time.monotonic()
    found = sandboxed.run(FAKE.name, ["while True: pass", "import time\ntime.sleep(600)", "x = ("], 1)
    assert [r.errors[0] for r in found] == [late, late, "error (line 1): SyntaxError: '(' was never closed"]
    assert time.monotonic() - begun < 300


def test_memory_and_output_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rendering, "MEMORY", 1 << 30)
    hungry = refused("held = []\nwhile True: held.append(bytearray(1 << 29))")
    assert hungry == "error: the program took more than 1 GB of memory"
    monkeypatch.setattr(rendering, "OUTPUT", 1 << 14)
    many = SHAPES + "for i in range(999): show_object(Face(box(i, 0, 1, 1)))"
    assert (
        refused(many)
        == "error: the program ended its process: it took too much memory, or crashed the library"
    )


def test_a_crash_is_told() -> None:
    crash = "import sys\nsys.modules['posix'].abort() if 'posix' in sys.modules else None\nraise SystemExit"
    assert refused(crash).startswith(("error: the program ended its process", "error (line 3): SystemExit"))


NO_DRAWING = "error: the program handed over what is no drawing"


def says(monkeypatch: pytest.MonkeyPatch, folder: Path, text: str) -> None:
    """Has something else write in place of the host, as a program that got out of its fence could."""
    host = folder / "host.py"
    host.write_text(f"import sys\nsys.stdin.read()\nsys.stdout.write({text!r})\n")
    monkeypatch.setattr(sandboxed, "_HOST", host)


HANDED_OVER = {
    '{"parts": [3], "lines": []}': NO_DRAWING,
    '{"parts": [[]], "lines": 7}': NO_DRAWING,
    '{"parts": {"faces": []}, "lines": []}': NO_DRAWING,
    '{"parts": [[[[["1", "2"]]]]], "lines": []}': NO_DRAWING,
    '{"parts": [[[[[true, 0]]]]], "lines": []}': NO_DRAWING,
    '{"parts": [[[[[1, 2, 3, 4]]]]], "lines": []}': NO_DRAWING,
    '{"parts": [[[[[1e999, 0]]]]], "lines": []}': UNBOUNDED,
    '{"parts": [], "lines": [[[0, 1' + "0" * 400 + "]]]}": UNBOUNDED,
    '{"parts": [], "lines": [[[0, NaN]]]}': UNBOUNDED,
    '{"kind": ["time"]}': NO_DRAWING,
    r'{"errors": ["\u001b[31mred \ud800 \u202e"]}': "␛[31mred <U+D800> <U+202E>",
}


def test_what_is_handed_over_is_a_drawing_or_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    says(monkeypatch, tmp_path, f"[{', '.join(HANDED_OVER)}]")
    found = sandboxed.run(FAKE.name, [""] * len(HANDED_OVER), 20)
    assert ["".join(rendered.errors) for rendered in found] == [*HANDED_OVER.values()]


@pytest.mark.parametrize("said", ["", "[", "[]", "[1]", "null", "{}", "[[], []]", "[{}, {}]"])
def test_a_host_that_is_taken_over_is_told(
    said: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    says(monkeypatch, tmp_path, said)
    assert refused("").startswith(("error: the program ended its process", NO_DRAWING))


def test_faces_are_read_with_their_holes() -> None:
    program = SHAPES + (
        "show_object(Face(box(0, 0, 30, 20), box(5, 5, 4, 4)), options={'color': 'Red'})\n"
        "show_object([Face(box(40, 0, 10, 10)), Face(box(50, 0, 10, 10))], color=(0, 0, 1))\n"
        "show_object(Face(box(70, 0, 2, 2)), 'name')\n"
    )
    drawn = run(program).regions
    assert [part.area for part in drawn.parts] == pytest.approx([600 - 16, 100, 100, 4])
    assert [len(part.faces[0].holes) for part in drawn.parts] == [1, 0, 0, 0]


KNOBS = """\
# 80 wide
width = 80
größe: float = -2.5
n = 3; twice = 2 * width
width_of = {"a": 3}
flag = True
n = 4
def part():
    inner = 5
"""


def test_knobs_are_the_numbers_at_the_top_that_are_given_once() -> None:
    assert FAKE.knobs(KNOBS) == {"width": 80.0, "größe": -2.5}
    assert FAKE.structures(KNOBS) == 1
    assert FAKE.knobs("x = (") == {}


def test_knobs_are_turned_where_they_are_written() -> None:
    program = (
        SHAPES + "länge, breite = 0, 0\nbreite_1 = 10\nb = -2\nshow_object(Face(box(0, 0, breite_1, -b)))"
    )
    found = FAKE.run(program, [{}, {"breite_1": 12.0}, {"breite_1": 7.5, "b": -4.0}])
    assert [r.regions.parts[0].area for r in found] == [20, 24, 30]


def test_without_a_library_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    absent = PythonCad("no_such_library")
    why = absent.missing()
    assert why is not None
    assert why.endswith(": name an interpreter that has it by AIDL_NO_SUCH_LIBRARY_PYTHON")
    monkeypatch.setenv("AIDL_NO_SUCH_LIBRARY_PYTHON", "/no/python")
    assert str(absent.missing()).startswith("`/no/python` (of AIDL_NO_SUCH_LIBRARY_PYTHON) cannot be run: ")
