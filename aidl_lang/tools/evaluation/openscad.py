"""OpenSCAD as the language of a conversation, for comparison: an installed one runs the programs."""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.tools.llm.language import Verdict

Polygon = NDArray[np.float64]
"""Corners in order, shape (n, 2), mm, y up."""

COMMAND = "openscad"
_SECONDS = 30
_MEMORY, _OUTPUT = 2 << 30, 32 << 20
_SHOWN = 8
"""Most messages that the model is shown."""

_GUIDE = """\
You write OpenSCAD programs that draw flat parts. Lengths are millimetres, x runs to the right, y upwards.

- The drawing is flat: use `circle`, `square`, `polygon`, `text`, moved by `translate`, `rotate`, `scale`,
  `mirror`, joined by `union`, `difference`, `intersection`, `hull`, `minkowski` and `offset`. No solids.
- Give what somebody may want to change a name at the top of the file, as `width = 80;`, and compute from it.
- Write a `module` for each part that has a meaning, and call it where the part belongs.
- Use no files: neither `include` nor `use`, `import` or `surface`.

Answer with the whole program in one block that opens with ```openscad.
"""
_WHOLE = "answer with the whole program in one block that opens with ```openscad."
_WRONG = f"Mend this without leaving out any part of the drawing, and {_WHOLE}"
_VALID = f"The program draws something. If what is said above is not meant so, change it; {_WHOLE}"

_MESSAGE = re.compile(r"^(ERROR|WARNING|TRACE|DEPRECATED): *(.*)$", re.M)
_PLACE = re.compile(r",? in file [^,\n]*, line (\d+)")
_OUTLINE = re.compile(r'<path d="([^"]*)"')
_CORNER = re.compile(r"([^\s,MLz]+),([^\s,MLz]+)")
_PLAIN = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\])*"', re.S)
_FILES = re.compile(r"\b(?:include|use)\s*<|\b(?:import\w*|surface|dxf_\w+)\s*\(|\bfile\s*=")
_MODULE = re.compile(r"\bmodule\s+\w+")
_KNOB = re.compile(r"^\s*([A-Za-z_]\w*)\s*=\s*(-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*\Z")


@record()
class Rendered:
    """The result of a program: closed outlines, holes among them, and messages, errors first."""

    outlines: tuple[Polygon, ...] = ()
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        return not self.errors


@record()
class OpenScad:
    """The language. `is_installed` tells whether its programs can be judged here."""

    name: str = "openscad"
    suffix: str = ".scad"
    fences: tuple[str, ...] = ("openscad", "scad")

    @property
    def is_installed(self) -> bool:
        return shutil.which(COMMAND) is not None

    def guide(self) -> str:
        return _GUIDE

    def reads(self, text: str) -> bool:
        return render(text).ok

    def conversation(self, before: str | None = None) -> OpenScadConversation:
        return OpenScadConversation()


@record(frozen=False)
class OpenScadConversation:
    """Judges each program by itself; a remark is made once."""

    told: set[str] = field(default_factory=set)

    def judge(self, program: str) -> Verdict:
        rendered = render(program)
        said = "\n".join((*rendered.errors, *rendered.warnings)[:_SHOWN])
        if rendered.ok and said in self.told:
            said = ""
        self.told.add(said)
        return Verdict(
            ok=rendered.ok,
            stage="done" if rendered.ok else "render",
            feedback=f"{said}\n\n{_VALID if rendered.ok else _WRONG}" if said else "",
            program=program,
            codes=tuple(re.split(r" \(|:", error)[0] for error in rendered.errors),
            weight=(int(not rendered.ok), len(rendered.errors), len(rendered.warnings)),
            numbers={"structures": structures(program), "warnings": len(rendered.warnings)},
        )

    def finish(self, verdict: Verdict) -> Verdict:
        return verdict


def structures(program: str) -> int:
    """Counts the modules that a program defines."""
    return len(_MODULE.findall(_bare(program)))


def knobs(program: str) -> dict[str, float]:
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


def render(program: str, knobs: Mapping[str, float] | None = None) -> Rendered:
    """Run a program, with other values for some of its variables. It is kept from reading files.

    The limits on time, memory and output are set in the process that is started: call this where no other
    thread runs.
    """
    if "\0" in program or _FILES.search(_bare(program)):
        return Rendered(
            errors=("error: files cannot be read: do without `include`, `use`, `import` and `surface`",)
        )
    with tempfile.TemporaryDirectory() as folder:
        drawing, said = Path(folder, "drawing.svg"), Path(folder, "said")
        Path(folder, "program.scad").write_text(program, "utf-8", errors="replace")
        values = [part for name, value in (knobs or {}).items() for part in ("-D", f"{name}={value!r}")]
        try:
            with open(said, "wb") as output:
                code = subprocess.run(
                    [COMMAND, "-o", drawing.name, *values, "program.scad"],
                    cwd=folder,
                    env={"HOME": folder, "PATH": "/usr/local/bin:/usr/bin:/bin", "OPENSCADPATH": folder},
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    timeout=_SECONDS,
                    preexec_fn=_limit,
                ).returncode
        except subprocess.TimeoutExpired:
            return Rendered(errors=(f"error: rendering took longer than {_SECONDS} s",))
        text = said.read_bytes()[: _OUTPUT // 32].decode("utf-8", "replace")
        errors, warnings = _messages(text)
        if code:
            return Rendered(errors=errors or (_failure(code, text),), warnings=warnings)
        return _outlined(drawing.read_text("utf-8"), errors, warnings)


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (_SECONDS, _SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (_OUTPUT, _OUTPUT))


def _bare(program: str) -> str:
    """Returns a program without comments and texts."""
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
    return "error: nothing is drawn"


def _outlined(svg: str, errors: tuple[str, ...], warnings: tuple[str, ...]) -> Rendered:
    outlines = [
        np.array(_CORNER.findall(part), float) * (1.0, -1.0)
        for path in _OUTLINE.findall(svg)
        for part in path.split("z")
        if "," in part
    ]
    if not outlines:
        return Rendered(errors=(*errors, "error: nothing is drawn"), warnings=warnings)
    if not all(np.isfinite(outline).all() for outline in outlines):
        return Rendered(errors=(*errors, "error: a coordinate is not a finite number"), warnings=warnings)
    return Rendered(tuple(outlines), errors, warnings)
