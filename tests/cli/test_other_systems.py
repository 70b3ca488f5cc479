"""What only POSIX systems have is taken away: every module loads and every command works without it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.documents import ROOT

ELSEWHERE = '''
import os
import signal
import sys


class Missing:
    """Finds no module that Windows has not, for AIDL; other packages go by the name of the system."""

    def find_spec(self, name, path=None, target=None):
        frame = sys._getframe(1)
        while frame and frame.f_code.co_filename.startswith("<frozen importlib"):
            frame = frame.f_back
        is_ours = frame and frame.f_globals.get("__name__", "").startswith(("aidl_lang", "__main__"))
        if is_ours and name in ("fcntl", "grp", "pty", "pwd", "readline", "resource", "termios", "tty"):
            raise ModuleNotFoundError(f"no module named {name!r}", name=name)


for name in ("fcntl", "grp", "pwd", "readline", "resource", "termios"):
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Missing())
for name in ("O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK"):
    delattr(os, name)
for name in ("fchmod", "fork", "getuid", "killpg", "sched_getaffinity"):
    delattr(os, name)
os.supports_dir_fd = set()
# SIGKILL stays: `multiprocessing` ends processes by it here
for name in ("SIGHUP", "SIGALRM", "SIGUSR1", "pthread_sigmask"):
    delattr(signal, name)
'''
PLATE = """\
solid plate {
    param width = 60 in 40..80
    body = rectangle(width: width, height: 20)
    hole eye { rim = circle(radius: 4) }
}
"""


COMMANDS = {
    "compile plate.aidl -o p.svg -o p.dxf -o p.pdf -o p.png -o p.json": "solved",
    "check plate.aidl": "no mistakes found",
    "sweep plate.aidl --jobs 1 -D width=50 -o {n}.svg -o t.csv": "1 variant, 1 well",
    "measure plate.aidl": "area",
    "show plate.aidl --protocol ascii": "___",
    "fmt --check plate.aidl": "",
    "doc slot": "slot(",
    "compile all.aidl -o all.svg": "solved",
}
"""What a command says; the last one imports, by folders that cannot be held open."""
ALL = """
import importlib, pkgutil, re, sys
from pathlib import Path
import aidl_lang
from aidl_lang.tools.cli import main

if __name__ == "__main__":  # not in the processes that a command starts
    try:
        import fcntl
    except ImportError:
        print("gone\\f", end="", flush=True)
    for words in sys.argv[1:]:
        assert main(words.split()) == 0, words
        print("\\f", end="", flush=True)
    from unittest.mock import MagicMock
    step = Path(aidl_lang.__file__).parent / "export" / "step.py"
    for name in ("OCP", *re.findall(r"(?:import|from) (OCP[.\\w]+)", step.read_text("utf-8"))):
        sys.modules[name] = MagicMock()  # which takes seconds to load
    for found in pkgutil.walk_packages(aidl_lang.__path__, "aidl_lang."):
        found.name.endswith("__main__") or importlib.import_module(found.name)
    print("all")
"""


def test_commands_work_and_every_module_loads(tmp_path: Path) -> None:
    work, taken = tmp_path / "work", tmp_path / "taken"
    taken.mkdir()
    (taken / "sitecustomize.py").write_text(ELSEWHERE)  # for each Python that starts
    (work / "parts").mkdir(parents=True)
    (work / "plate.aidl").write_text(PLATE)
    (work / "parts" / "washer.aidl").write_text("solid washer(d) { rim = circle(diameter: d) }")
    (work / "all.aidl").write_text('import "parts/washer.aidl"\nassembly a { w = washer(d: 9) }\n')
    (work / "all.py").write_text(ALL)
    path = os.pathsep.join([str(taken), str(ROOT)])
    done = subprocess.run(
        [sys.executable, "all.py", *COMMANDS],
        cwd=work,
        env={**os.environ, "PYTHONPATH": path, "NO_COLOR": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    assert "Traceback" not in done.stdout, done.stdout
    begun, *said, end = done.stdout.split("\f")
    assert (begun, end) == ("gone", "all\n")
    for (words, says), of_it in zip(COMMANDS.items(), said, strict=True):
        assert says in of_it, words
