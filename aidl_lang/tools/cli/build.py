"""`aidl compile`, `watch`, `sheet` and `show`: compiles a program, and draws it in files or the terminal."""

from __future__ import annotations

import argparse
import os
import re
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import AidlError, TooLongError
from aidl_lang.common.materials import PAPERS
from aidl_lang.common.prose import counted, first_few
from aidl_lang.common.records import record
from aidl_lang.common.world import is_data, may_be_read
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, pass_by, say, show
from aidl_lang.tools.cli.options import (
    add_drawing,
    add_look,
    add_outputs,
    add_params,
    add_pixels,
    add_program,
    add_strict,
    add_variant,
    choice,
    count_to,
    flag,
    options,
    profile,
    value,
)

if TYPE_CHECKING:
    from aidl_lang.common.diagnostics import Diagnostic
    from aidl_lang.export.job import Options
    from aidl_lang.export.marks import Picture, Text
    from aidl_lang.pipeline import Compiled
    from aidl_lang.solver.hierarchy import Memory
    from aidl_lang.solver.problem import StageReport
    from aidl_lang.tools.terminal import Label, Screen


_DEFAULT_FORMAT = ".svg"
_MOST_NAMES = 8
"""Files that are told by name."""
_PATIENCE = 1.0
"""Seconds after which progress is shown."""


Target = tuple[str, str]
"""The name of a file to write, and the format of its content."""


@record()
class BuildResult:
    """The result of one run; `read` has the files beside the program that it asked for, there or not."""

    compiled: Compiled
    written: tuple[str, ...]
    notes: tuple[Diagnostic, ...]
    seconds: float
    read: frozenset[Path] = frozenset()

    @property
    def code(self) -> int:
        return exit_code(self.compiled.errors) or (0 if self.compiled.ok else 1)

    def motions(self, most: int) -> list[str]:
        from aidl_lang.geometry.freedom import report

        model = self.compiled.model
        return [] if model is None or not self.compiled.ok else report(model, most)

    def line(self, program: str) -> str:
        model = self.compiled.model
        freedom = ""
        if model is not None and model.degrees is not None and self.compiled.ok:
            freedom = f", {counted(model.degrees, 'degree')} of freedom"
        written = first_few(self.written, _MOST_NAMES)
        place, remark = (written, "") if written else (program, ", nothing written")
        is_off = self.compiled.status == "solved" and not self.compiled.ok
        status = "errors after solving" if is_off else self.compiled.status
        return f"{place}: {status}{freedom}{remark}, {self.seconds:.2f} s"


def targets(arguments: argparse.Namespace) -> tuple[Target, ...]:
    """Returns the outputs asked for; refuses those whose format or directory does not exist."""
    from aidl_lang.export.job import is_pattern

    names = arguments.output or [_beside(arguments.file, _DEFAULT_FORMAT)]
    found = tuple((name, _suffix(name, arguments.format)) for name in names)
    for name in names:
        if not is_pattern(name):
            files.require_directory(name)
    files.require_unread(names)
    return found


def build(arguments: argparse.Namespace, memory: Memory | None = None) -> BuildResult:
    """Compiles and writes. Nothing is written unless every output could be made.

    With a `memory` of the last run, only what has changed since then is solved again.
    """
    from aidl_lang import pipeline
    from aidl_lang.common.world import KeptWorld

    start = time.perf_counter()
    source = files.read(arguments.file)
    outputs = targets(arguments)
    profile(arguments.profile)  # a wrong one is told before any work is done
    disk = files.world(arguments.file)
    world = KeptWorld(disk)
    params, show = dict(arguments.params), tuple(sorted(arguments.show))
    settings = pipeline.Settings.of(arguments.variant, strict=arguments.strict)
    compiled = pipeline.compile(source, world, params, settings, show, memory)
    read = frozenset((disk.root / path).resolve() for path in world.asked)
    written: tuple[str, ...] = ()
    notes: tuple[Diagnostic, ...] = ()
    if compiled.ok or (arguments.best_effort and compiled.drawing is not None):
        written, notes = _write(compiled, outputs, options(arguments, compiled))
    return BuildResult(compiled, written, notes, time.perf_counter() - start, read)


def _write(
    compiled: Compiled, outputs: Sequence[Target], options: Options
) -> tuple[tuple[str, ...], tuple[Diagnostic, ...]]:
    """Writes all outputs once all could be made, over nothing that was read. Returns names and remarks."""
    from aidl_lang.export.job import contents, is_pattern

    made: list[tuple[str, bytes]] = []
    notes: list[Diagnostic] = []
    writing = compiled.exporting(options, _Progress())
    for target, suffix in outputs:
        found, said = contents(writing, target, suffix)
        require_one(target, len(found))
        if suffix != ".json" and any(note.code == "W0721" for note in said):
            _keep_drawn(found)
        made += found
        notes += said
    _require_apart([name for name, _ in made])
    files.require_unread(name for name, _ in made)
    if any(is_pattern(target) for target, _ in outputs):
        files.make_directories(name for name, _ in made)
    for name, data in made:
        files.write(name, data)
    return tuple(name for name, _ in made), tuple(dict.fromkeys(notes))


def _keep_drawn(made: Iterable[tuple[str, bytes]]) -> None:
    """Refuses to replace files by drawings of nothing; the same drawing of nothing may be written again."""
    for name, data in made:
        path = Path(name)
        if name != files.STANDARD and path.is_file() and path.read_bytes() != data:
            raise UseError(
                "E0929",
                f"nothing is drawn, so `{name}` is left as it is",
                "if it shall be empty, delete it first",
                "`aidl check` tells why nothing is drawn",
            )


def _require_apart(names: Sequence[str]) -> None:
    """Refuses to write two contents into one file."""
    seen: set[Path] = set()
    for name in names:
        place = Path(name).resolve()
        if name != files.STANDARD and place in seen:
            hint = "give each a name of its own: further sheets, pages and parts have names made of it"
            raise UseError("E0927", f"two outputs go to `{name}`, and nothing is written", hint)
        seen.add(place)


class _Progress:
    """Tells how many outlines are widened, if that takes over a second."""

    def __init__(self) -> None:
        self._start: float | None = None

    def __call__(self, done: int, count: int) -> None:
        self._start = self._start or time.monotonic()
        if time.monotonic() - self._start > _PATIENCE:
            pass_by(f"{done} of {count} outlines widened by the cut" if done < count else "")


def require_one(name: str, count: int) -> None:
    """Refuses several files on standard output."""
    if count > 1 and name == files.STANDARD:
        raise UseError("E0914", f"{count} files do not fit on standard output", "name a file with -o")


def _beside(program: str, suffix: str) -> str:
    return files.STANDARD if program == files.STANDARD else str(Path(program).with_suffix(suffix))


def _suffix(name: str, fallback: str | None) -> str:
    from aidl_lang.export import suffix_of

    return suffix_of(name, fallback or _DEFAULT_FORMAT * (name == files.STANDARD))


_MOST_MOTIONS = 6
"""Most lines about remaining motions."""


def register_compile(parser: argparse.ArgumentParser) -> None:
    """`aidl compile`: a program in, drawings out."""
    add_program(parser)
    add_drawing(parser)
    add_variant(parser)
    add_strict(parser)
    flag(parser, "--quiet", "say nothing but errors")
    flag(parser, "--timings", "tell how long each stage took")
    flag(parser, "--trace-solve", "tell which structures were solved in which stages")


def run_compile(arguments: argparse.Namespace) -> int:
    outcome = build(arguments)
    told = outcome.compiled.errors if arguments.quiet else outcome.compiled.diagnostics
    show([*told, *outcome.notes], arguments.quiet)
    if arguments.trace_solve:
        _show_stages(outcome.compiled.stages)
    if arguments.timings:
        timings = outcome.compiled.timings
        for stage, seconds in [*timings.items(), ("total", sum(timings.values()))]:
            say(f"{stage:<12}{1000 * seconds:>9.1f} ms")
    if not arguments.quiet:
        say(outcome.line(arguments.file))
        for sentence in outcome.motions(_MOST_MOTIONS):
            say(f"  {sentence}")
    return outcome.code


def _show_stages(stages: Sequence[tuple[str, StageReport]]) -> None:
    width = max((len(path) for path, _ in stages), default=0)
    width = max(width, len("structure"))
    say(f"{'structure':<{width}}  {'stage':<16}{'unknowns':>9}{'rows':>6}")
    for path, stage in stages:
        result = "solved" if stage.succeeded else "not enough"
        say(f"{path:<{width}}  {stage.stage:<16}{stage.unknowns:>9}{stage.rows:>6}  {result}")
    if not stages:
        say("nothing to solve: every constraint holds as written")


def register_watch(parser: argparse.ArgumentParser) -> None:
    """`aidl watch`: draw a program again whenever it, or a file beside it that it may read, is saved."""
    parser.epilog = (
        "All programs in its folder and below are watched, and the drawings (.svg, .dxf) and fonts that it "
        "reads, so that a change to an import counts too."
    )
    add_program(parser)
    add_drawing(parser)
    add_variant(parser)
    add_strict(parser)
    parser.set_defaults(timings=False)


def run_watch(arguments: argparse.Namespace) -> int:
    from watchfiles import watch

    from aidl_lang.solver.hierarchy import Memory

    files.require_watchable(arguments.file)
    targets(arguments)
    program, memory = Path(arguments.file).resolve(), Memory()
    read = _once(arguments, memory)
    for changes in watch(program.parent, watch_filter=lambda _, path: may_be_read(path)):
        paths = {Path(path) for _, path in changes}
        # Programs are few; what is written here may be a drawing itself, and starts nothing.
        if any(not is_data(path) for path in paths) or paths & read:
            read = _once(arguments, memory) or read
    return 0


def _once(arguments: argparse.Namespace, memory: Memory) -> frozenset[Path]:
    """Runs once, with one line of report; a missing file does not end the watch. Returns the files read."""
    from aidl_lang.common.render import one_line

    clock = time.strftime("%H:%M:%S")
    try:
        outcome = build(arguments, memory)
    except AidlError as reason:
        if isinstance(reason, TooLongError):
            raise
        say(f"{clock} {one_line(reason.diagnostic)}")
        return frozenset()
    errors = outcome.compiled.errors
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    say(f"{clock} {one_line(errors[0])}{more}" if errors else f"{clock} {outcome.line(arguments.file)}")
    return outcome.read


_SHEET = ".pdf"


def register_sheet(parser: argparse.ArgumentParser) -> None:
    """`aidl sheet`: a technical drawing on paper, with dimensions, a frame and a title block."""
    add_program(parser)
    add_outputs(
        parser, "where to write: .pdf, .svg or .png; may be given several times (default: FILE with .pdf)"
    )
    add_params(parser)
    value(parser, "--paper", "NAME", f"{', '.join(PAPERS)} (default: by fit)", _paper)
    way = parser.add_mutually_exclusive_group()
    way.add_argument(
        "--landscape", dest="landscape", action="store_const", const=True, help="lay the paper wide"
    )
    way.add_argument("--portrait", dest="landscape", action="store_const", const=False, help="stand it up")
    value(parser, "--scale", "N:M", "as in 1:2 (default: by fit)", _scale)
    value(parser, "--date", "TEXT", "the date in the title block (default: none)", str, "")
    choice(parser, "--standard", ("iso", "ansi"), "paper and projection (default: iso)")
    add_pixels(parser)


def run_sheet(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.export.drafting import Draft
    from aidl_lang.export.job import Options, file_names

    start = time.perf_counter()
    source = files.read(arguments.file)
    names = arguments.output or [_beside(arguments.file, _SHEET)]
    suffixes = list(map(sheet_suffix, names))
    for name in names:
        files.require_directory(name)
    compiled = pipeline.compile(source, files.world(arguments.file), params=dict(arguments.params))
    show(compiled.diagnostics)
    if not compiled.ok:
        return exit_code(compiled.diagnostics) or 1
    draft = Draft(
        arguments.paper, arguments.landscape, arguments.scale, arguments.standard, arguments.date.strip()
    )
    made = compiled.drafted(suffixes, draft, Options(pixels=arguments.pixels))
    written = []
    for target, result in zip(names, made, strict=True):
        datas = (result.data, *result.further)
        require_one(target, len(datas))
        for name, data in zip(file_names(target, len(datas)), datas, strict=True):
            files.write(name, data)
            written.append(name)
    show(dict.fromkeys(note for result in made for note in result.notes))
    say(f"{', '.join(written)}: {time.perf_counter() - start:.2f} s")
    return exit_code(compiled.diagnostics)


def sheet_suffix(name: str) -> str:
    """Returns the format of a sheet. Raises ExportError for one that has none."""
    from aidl_lang.export import PICTURES, suffix_of

    fallback = _SHEET * (name == files.STANDARD)
    return suffix_of(name, fallback, PICTURES, "there are no sheets of the format `{}`")


def _paper(text: str) -> str:
    name = text.strip().lower()
    if name not in PAPERS:
        raise argparse.ArgumentTypeError(f"there is no `{text}`; there are {', '.join(PAPERS)}")
    return name


def _scale(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"\s*([1-9]\d{0,4})\s*[:/]\s*([1-9]\d{0,4})\s*", text)
    if found is None:
        raise argparse.ArgumentTypeError(f"expected a scale such as 1:2 or 5:1, not `{text}`")
    return int(found[1]), int(found[2])


# --- A preview of the drawing in the terminal.

_PROMPT = 2
"""Rows left free: for the command, and for the prompt after it."""
_SAMPLES = 4
"""Pixels drawn per shown pixel, across and down."""


def register_show(parser: argparse.ArgumentParser) -> None:
    """`aidl show`: a preview of the drawing in the terminal."""
    add_program(parser)
    add_params(parser)
    add_look(parser)
    value(parser, "--width", "COLUMNS", "columns to fill at most (default: the terminal)", count_to(1000))
    protocols = ("auto", "kitty", "iterm", "sixel", "blocks", "braille", "ascii")
    about = "how to show it (default: auto, the best that the terminal is known for)"
    choice(parser, "--protocol", protocols, about)


def run_show(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.common.render import wants_colour
    from aidl_lang.export import require_sheets
    from aidl_lang.export.job import Job, Options
    from aidl_lang.export.picture import picture
    from aidl_lang.tools.terminal import protocol

    options = Options(arguments.show, arguments.dimension, arguments.cut, theme=arguments.theme)
    require_sheets(options)
    source, world = files.read(arguments.file), files.world(arguments.file)
    layers = tuple(sorted(arguments.show))
    compiled = pipeline.compile(source, world, params=dict(arguments.params), show=layers)
    show(compiled.diagnostics)
    may_be_shown = compiled.ok or arguments.best_effort
    if may_be_shown and compiled.model is not None and compiled.drawing is not None:
        drawn = picture(Job(compiled.model, compiled.drawing, options=options))
        name, out = arguments.protocol, sys.stdout
        if name == "auto":
            has_colour = wants_colour(out, os.environ)
            name = protocol(os.environ, out.encoding, is_terminal=out.isatty(), has_colour=has_colour)
        files.write(files.STANDARD, _shown(drawn, name, _screen(arguments.width)))
    return exit_code(compiled.diagnostics) or int(not compiled.ok)


def _screen(width: int | None) -> Screen:
    """Returns the room for a picture; in a file up to twice as high as `width`."""
    import shutil

    from aidl_lang.tools.terminal import Screen, cell_size

    size = shutil.get_terminal_size()
    rows = max(1, size.lines - _PROMPT)
    if sys.stdout.isatty():
        return Screen(min(width or size.columns, size.columns), rows, cell_size(sys.stdout.fileno()))
    return Screen(width or size.columns, width or rows)


def _shown(picture: Picture, name: str, screen: Screen) -> bytes:
    from aidl_lang.export.marks import coarse, framed
    from aidl_lang.tools.terminal import GRAPHICS, fit, iterm, kitty, sixel

    extent = fit(picture.width, picture.height, screen)
    across, down = extent.pixels
    picture = framed(picture, across / down)
    if name not in GRAPHICS:
        return _characters(picture, name, extent)
    png = _png(coarse(picture, picture.width / across), max(across, down))
    if name == "sixel":
        return f"{sixel(png)}\n".encode()
    return f"{(kitty if name == 'kitty' else iterm)(png, extent.columns, extent.rows)}\n".encode()


def _characters(picture: Picture, name: str, extent: Screen) -> bytes:
    from aidl_lang.export.marks import coarse, outlined, separated
    from aidl_lang.tools.terminal import PIXELS, cells, has_true_colour, text, written

    across, down = extent.columns * PIXELS[name][0], extent.rows * PIXELS[name][1]
    picture, texts = separated(picture if name == "blocks" else outlined(picture))
    png = _png(coarse(picture, picture.width / across), _SAMPLES * max(across, down))
    grid = cells(name, png, extent.columns, extent.rows)
    labels = [_label(mark, picture, extent) for mark in texts]
    grid = written(grid, labels, only_ascii=name == "ascii")
    lines = text(grid, true_colour=has_true_colour(os.environ))
    return lines.encode(sys.stdout.encoding, "replace")


def _label(mark: Text, picture: Picture, extent: Screen) -> Label:
    """Returns a text of the picture in cells. A turned one is written level, about its middle."""
    from aidl_lang.common.colors import rgb
    from aidl_lang.tools.terminal import Label

    left, bottom, right, top = mark.box
    edge = {"start": left, "middle": (left + right) / 2, "end": right}
    anchor = "middle" if mark.angle else mark.anchor
    column = (edge[anchor] - picture.box[0]) / picture.width * extent.columns
    row = (picture.box[3] - (bottom + top) / 2) / picture.height * extent.rows
    return Label(mark.text, column, row, anchor, rgb(mark.color))


def _png(picture: Picture, pixels: int) -> bytes:
    from aidl_lang.export import render
    from aidl_lang.export.job import Options

    return render(picture, ".png", Options(pixels=pixels))
