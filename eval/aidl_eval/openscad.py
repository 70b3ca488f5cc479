"""OpenSCAD as the language of a conversation, for comparison: an installed one runs the programs."""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from aidl_eval import rendering, shapes
from aidl_eval.regions import Regions
from aidl_eval.rendering import NOTHING, UNBOUNDED, Rendered, RenderedLanguage
from aidl_eval.sandbox import fence

COMMAND = "openscad"
_MOST = 48
"""Most parts that a drawing is taken apart into."""
_TREE = 4 << 20
"""Characters of a tree above which it is not taken apart."""

_MESSAGE = re.compile(r"^(ERROR|WARNING|TRACE|DEPRECATED): *(.*)$", re.M)
_PLACE = re.compile(r",? in file [^,\n]*, line (\d+)")
_OUTLINE = re.compile(r'<path d="([^"]*)"')
_CORNER = re.compile(r"([^\s,MLz]+),([^\s,MLz]+)")
_PLAIN = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\])*"', re.S)
_FILES = re.compile(r"\b(?:include|use)\s*<|\b(?:import\w*|surface|dxf_\w+)\s*\(|\bfile\s*=")
_AROUND = re.compile(r"(group\(\)|color\(|multmatrix\()")
_MODULE = re.compile(r"\bmodule\s+\w+")
_KNOB = re.compile(r"^\s*([A-Za-z_]\w*)\s*=\s*(-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*\Z")


@dataclass(frozen=True)
class OpenScad(RenderedLanguage):
    name: str = "openscad"
    suffix: str = ".scad"
    fences: tuple[str, ...] = ("openscad", "scad")

    def missing(self) -> str | None:
        path = shutil.which(COMMAND)
        return _unlockable(path) if path else "it is not installed"

    def reads(self, text: str) -> bool:
        return render(text).ok

    def structures(self, program: str) -> int:
        """Counts the modules that a program defines."""
        return len(_MODULE.findall(_bare(program)))

    def knobs(self, program: str) -> dict[str, float]:
        """Returns the top-level variables that are plain numbers; the last definition of a name counts."""
        depth, start, found, bare = 0, 0, dict[str, float](), _bare(program)
        for index, character in enumerate(bare):
            depth += (character in "({[") - (character in ")}]")
            if depth == 0 and character in ";}":
                match = _KNOB.match(bare[start:index])
                if match and character == ";":
                    found[match[1]] = float(match[2])
                start = index + 1
        return found

    def run(self, program: str, edits: Sequence[Mapping[str, float]] = ({},)) -> list[Rendered]:
        return [_parted(program, edit) for edit in edits]

    def judged(self, program: str) -> Rendered:
        return render(program)


@cache
def _unlockable(path: str) -> str | None:
    """Returns the reason why an OpenSCAD does not run locked in; None if it does."""
    errors = render("square(1);").errors
    return f"`{path}` does not run locked in ({errors[0]})" if errors else None


def render(program: str, knobs: Mapping[str, float] | None = None) -> Rendered:
    """Runs a program, with other values for some of its variables, and returns all it draws as one part. It
    is kept from reading files.

    The limits on time, memory and output are set in the process that is started: call this where no other
    thread runs.
    """
    if "\0" in program or _FILES.search(_bare(program)):
        return Rendered(
            errors=("error: files cannot be read: do without `include`, `use`, `import` and `surface`",)
        )
    code, text, drawn = _called(program, "drawing.svg", knobs)
    if code is None:
        return Rendered(errors=(f"error: rendering took longer than {rendering.SECONDS} s",))
    errors, warnings = _messages(text)
    if code:
        return Rendered(errors=errors or (_failure(code, text),), warnings=warnings)
    outlines = [
        np.array(_CORNER.findall(part), float) * (1.0, -1.0)
        for path in _OUTLINE.findall(drawn)
        for part in path.split("z")
        if "," in part
    ]
    if not all((np.abs(outline) < rendering.LARGEST).all() for outline in outlines):
        return Rendered(errors=(*errors, UNBOUNDED), warnings=warnings)
    region = shapes.region(outlines)
    return Rendered(Regions((region,) if region else ()), errors if region else (*errors, NOTHING), warnings)


def _called(program: str, output: str, knobs: Mapping[str, float] | None) -> tuple[int | None, str, str]:
    """Returns how OpenSCAD ended (None: late), what it said and what it wrote."""
    values = [part for name, value in (knobs or {}).items() for part in ("-D", f"{name}={value!r}")]
    with tempfile.TemporaryDirectory() as folder:
        drawing, said = Path(folder, output), Path(folder, "said")
        Path(folder, "program.scad").write_text(program, "utf-8", errors="replace")
        try:
            with open(said, "wb") as file:
                code = subprocess.run(
                    [COMMAND, "-o", output, *values, "program.scad"],
                    cwd=folder,
                    env={"HOME": folder, "PATH": "/usr/local/bin:/usr/bin:/bin", "OPENSCADPATH": folder},
                    stdin=subprocess.DEVNULL,
                    stdout=file,
                    stderr=subprocess.STDOUT,
                    timeout=rendering.SECONDS,
                    preexec_fn=partial(_limit, folder),
                ).returncode
        except subprocess.TimeoutExpired:
            return None, "", ""
        text = said.read_bytes()[: rendering.OUTPUT // 32].decode("utf-8", "replace")
        return code, text, "" if code or not drawing.exists() else drawing.read_text("utf-8")


def _parted(program: str, knobs: Mapping[str, float]) -> Rendered:
    """Runs a program as `render` does, and draws what stands side by side in it as parts of their own, in
    the order of writing: OpenSCAD itself unites them.
    """
    whole = render(program, knobs)
    if not whole.ok:
        return whole
    code, _, tree = _called(program, "tree.csg", knobs)
    texts = parts(tree) if code == 0 and len(tree) <= _TREE else []
    if len(texts) < 2:
        return whole
    drawn = tuple(part for text in texts for part in render(text).regions.parts)
    return replace(whole, regions=Regions(drawn))


def parts(tree: str) -> list[str]:
    """Returns the subtrees of a tree (as OpenSCAD writes it) that stand side by side, each as a text that
    draws it alone: what groups, moves and colours hold, down to the first operation on shapes. Where they
    are too many, those of a level further up.
    """
    lines = [line.strip() for line in tree.splitlines() if line.strip()]
    level = [_Node(tuple(lines))] if lines else []
    while (finer := [inner for node in level for inner in _opened(node)]) != level and len(finer) <= _MOST:
        level = finer
    return [node.before + "\n".join(node.lines) + node.after for node in level]


@dataclass(frozen=True)
class _Node:
    """Lines of a tree that belong together, within opening and closing ones of moves around it."""

    lines: tuple[str, ...]
    before: str = ""
    after: str = ""


def _opened(node: _Node) -> list[_Node]:
    """Returns what a node holds side by side; itself, if that is one shape."""
    statements = _statements(node.lines)
    if len(statements) > 1:
        return [replace(node, lines=lines) for lines in statements]
    head = node.lines[0]
    if not _AROUND.match(head):
        return [node]
    if len(node.lines) < 3:
        return []  # an empty group
    inner = node.lines[1:-1]
    if head.startswith("multmatrix"):
        return [_Node(inner, f"{node.before}{head}\n", f"\n}}{node.after}")]
    return [replace(node, lines=inner)]


def _statements(lines: Sequence[str]) -> list[tuple[str, ...]]:
    """Returns lines by statement: each ends where its braces are closed."""
    found, start, depth = list[tuple[str, ...]](), 0, 0
    for number, line in enumerate(lines):
        bare = _PLAIN.sub("", line)
        depth += bare.count("{") - bare.count("}")
        if depth == 0:
            found.append(tuple(lines[start : number + 1]))
            start = number + 1
    return found


def _limit(folder: str) -> None:
    fence.fence(folder)
    resource.setrlimit(resource.RLIMIT_CPU, (rendering.SECONDS,) * 2)
    resource.setrlimit(resource.RLIMIT_AS, (rendering.MEMORY,) * 2)
    resource.setrlimit(resource.RLIMIT_FSIZE, (rendering.OUTPUT,) * 2)


def _bare(program: str) -> str:
    return _PLAIN.sub(" ", program)


def _messages(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Returns errors and warnings, each once, with its line."""
    errors, warnings = dict[str, None](), dict[str, None]()
    for kind, message in _MESSAGE.findall(text):
        place = _PLACE.search(message)
        line = f" (line {place[1]})" if place else ""
        said = f"{'error' if kind == 'ERROR' else 'warning'}{line}: {_PLACE.sub('', message).strip()}"
        if kind != "TRACE":
            (errors if kind == "ERROR" else warnings)[said] = None
    return tuple(errors), tuple(warnings)


def _failure(code: int, text: str) -> str:
    """Returns the reason for a missing drawing if no message gives one."""
    if code < 0:
        return f"error: OpenSCAD was stopped (signal {-code}): it took too much time, memory or room"
    if "3D object" in text:
        return "error: the drawing must be flat, not a solid: do without extrusion, `cube`, `sphere` …"
    return NOTHING
