"""Compiles a program and writes files, once for `compile`, again and again for `watch`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.prose import counted
from aidl_lang.common.records import record
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import UseError, exit_code

if TYPE_CHECKING:
    from aidl_lang.common.diagnostics import Diagnostic
    from aidl_lang.export import Options
    from aidl_lang.pipeline import Compiled
    from aidl_lang.solver.memory import Memory


_DEFAULT_FORMAT = ".svg"
_PATIENCE = 1.0
"""Seconds after which progress is shown."""


@record()
class Target:
    """A file to write and the format of its content."""

    name: str
    suffix: str


@record()
class BuildResult:
    """The result of one run."""

    compiled: Compiled
    written: tuple[str, ...]
    notes: tuple[Diagnostic, ...]
    seconds: float

    @property
    def code(self) -> int:
        return exit_code(self.compiled.diagnostics) or (0 if self.compiled.ok else 1)

    def motions(self, most: int) -> list[str]:
        """Returns the remaining motions, one sentence a line."""
        from aidl_lang.geometry.freedom import report

        model = self.compiled.model
        return [] if model is None or not self.compiled.ok else report(model, most)

    def line(self, program: str) -> str:
        """Returns the result in a line."""
        model = self.compiled.model
        freedom = ""
        if model is not None and model.degrees is not None and self.compiled.ok:
            freedom = f", {counted(model.degrees, 'degree')} of freedom"
        place, remark = (", ".join(self.written), "") if self.written else (program, ", nothing written")
        status = self.compiled.status
        if status == "solved" and not self.compiled.ok:
            status = "errors after solving"
        return f"{place}: {status}{freedom}{remark}, {self.seconds:.2f} s"


def targets(arguments: argparse.Namespace) -> tuple[Target, ...]:
    """Returns the outputs asked for; refuses those whose format or directory does not exist."""
    names = arguments.output or [_default_output(arguments.file)]
    found = tuple(Target(name, _suffix(name, arguments.format)) for name in names)
    for target in found:
        files.require_directory(target.name)
        if target.name != files.STANDARD and Path(target.name).resolve() == Path(arguments.file).resolve():
            raise UseError("E0908", f"`{target.name}` is the program itself and is not overwritten")
    return found


def build(arguments: argparse.Namespace, memory: Memory | None = None) -> BuildResult:
    """Compiles and writes. Nothing is written unless every output could be made.

    With a `memory` of the last run, only what has changed since then is solved again.
    """
    from aidl_lang import pipeline

    start = time.perf_counter()
    source = files.read(arguments.file)
    outputs = targets(arguments)
    world = files.world(arguments.file)
    params, show = dict(arguments.params), tuple(sorted(arguments.show))
    settings = pipeline.Settings.of(arguments.variant, strict=arguments.strict)
    compiled = pipeline.compile(source, world, params, settings, show, memory)
    written: tuple[str, ...] = ()
    notes: tuple[Diagnostic, ...] = ()
    if compiled.ok or (arguments.best_effort and compiled.drawing is not None):
        written, notes = _write(compiled, outputs, options(arguments, compiled))
    return BuildResult(compiled, written, notes, time.perf_counter() - start)


def options(arguments: argparse.Namespace, compiled: Compiled | None = None) -> Options:
    """Returns the options of an export as the command line says them; timings are those of a compile."""
    from aidl_lang.export import Options

    return Options(
        show=arguments.show,
        dimension=arguments.dimension,
        cut=arguments.cut,
        pixels=arguments.pixels,
        thickness=arguments.thickness,
        timings=compiled.timings if compiled is not None and arguments.timings else None,
        sheet=arguments.sheet,
        spacing=arguments.spacing,
        nest=arguments.nest,
        kerf=arguments.kerf,
        tile=arguments.tile,
        overlap=arguments.overlap,
        theme=arguments.theme,
        dxf=arguments.dxf,
        tolerance=arguments.tolerance,
    )


def _write(
    compiled: Compiled, outputs: Sequence[Target], options: Options
) -> tuple[tuple[str, ...], tuple[Diagnostic, ...]]:
    """Writes all outputs once all could be made; returns their names, and diagnostics about them."""
    from aidl_lang.export import ExportError

    try:
        write = compiled.exporting(options, _Progress())
        made = [(target, write(target.suffix)) for target in outputs]
    except ExportError as reason:
        raise UseError.of(reason.diagnostic) from None
    contents = [
        (name, data)
        for target, result in made
        for name, data in zip(
            target_names(target, len(result.further)), (result.data, *result.further), strict=True
        )
    ]
    for name, data in contents:
        files.write(name, data)
    notes = dict.fromkeys(note for _, result in made for note in result.notes)
    return tuple(name for name, _ in contents), tuple(notes)


class _Progress:
    """Prints on a terminal how many outlines are widened, if that takes over a second, and removes it."""

    def __init__(self) -> None:
        self._start: float | None = None

    def __call__(self, done: int, count: int) -> None:
        now = time.monotonic()
        self._start = self._start or now
        if now - self._start > _PATIENCE and sys.stderr.isatty():
            text = f"{done} of {count} outlines widened by the cut" if done < count else ""
            print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def target_names(target: Target, further: int) -> list[str]:
    """Returns the name of the output, and those of further files."""
    from aidl_lang.export import file_names

    if further and target.name == files.STANDARD:
        raise UseError("E0914", f"{further + 1} files do not fit on standard output", "name a file with -o")
    return file_names(target.name, further + 1)


def _default_output(program: str) -> str:
    return files.STANDARD if program == files.STANDARD else str(Path(program).with_suffix(_DEFAULT_FORMAT))


def _suffix(name: str, fallback: str | None) -> str:
    """Returns the format of an output: its own suffix, else `--format`, else SVG on standard output."""
    from aidl_lang.export import ExportError, suffix_of

    try:
        return suffix_of(name, fallback or _DEFAULT_FORMAT * (name == files.STANDARD))
    except ExportError as reason:
        raise UseError.of(reason.diagnostic) from None
