"""`aidl generate` and `aidl eval`: programs by a language model, and how well models do."""

from __future__ import annotations

import argparse
import difflib
import json
import os
import re
import time
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.prose import counted, first_few, shortened
from aidl_lang.common.records import record
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, pass_by, say, show
from aidl_lang.tools.cli.options import add_outputs, add_provider, count_to, flag, provider, sampling, value

if TYPE_CHECKING:
    from aidl_lang.tools.llm.generation import Generation, Task
    from aidl_lang.tools.llm.messages import Language, Provider


_PROGRAM = ".aidl"
_CODES = 4
"""Most error codes in the line of an attempt."""


def register_generate(parser: argparse.ArgumentParser) -> None:
    """`aidl generate`: from a sentence to a program that is right, by a language model."""
    parser.add_argument("request", metavar="REQUEST", help="what to draw, or with --edit what to change")
    add_outputs(
        parser,
        "where to write: the program (.aidl) and drawings of it (.svg, .png, …); may be given several "
        "times (default: the program, or with --edit the change, on standard output)",
    )
    value(parser, "--edit", "FILE", "change this program instead of writing a new one")
    value(parser, "--image", "FILE", "a picture of what is meant (PNG, JPEG, WebP, GIF)")
    value(parser, "--attempts", "N", "replies to ask for at most (default: 5)", count_to(100), 5)
    value(parser, "--runs", "N", "conversations to have; the best is kept", count_to(100), 1)
    flag(parser, "--robust", "ask once more with what changes kind over the range of each param")
    value(parser, "--transcript", "FILE", "where to write the conversation (default: beside the program)")
    add_provider(parser)


def run_generate(arguments: argparse.Namespace) -> int:
    places = _places(arguments)
    from aidl_lang.tools.llm.generation import Task
    from aidl_lang.tools.llm.messages import read_image

    image = read_image(arguments.image, files.reads) if arguments.image else None
    task = Task(arguments.request, image, files.read(arguments.edit).text if arguments.edit else None)
    asked = provider(arguments)
    language = _language(arguments)
    done = [_conversation(arguments, places, task, asked, language, k) for k in range(arguments.runs)]
    weights = [run.verdict.weight if run.verdict is not None else (2,) for run in done]
    best = min(range(len(done)), key=lambda k: weights[k])
    return _deliver(arguments, places, done[best], f"run {best + 1}: " if len(done) > 1 else "")


@record()
class _Places:
    """Outputs: of the program (None: standard output), of drawings, and of the transcript."""

    program: str | None
    drawings: tuple[str, ...]
    transcript: str | None


def _places(arguments: argparse.Namespace) -> _Places:
    from aidl_lang.export import FORMATS

    programs = [name for name in arguments.output if Path(name).suffix.lower() == _PROGRAM]
    drawings = tuple(name for name in arguments.output if name not in programs)
    for name in drawings:
        if name == files.STANDARD or Path(name).suffix.lower() not in FORMATS:
            known = ", ".join(sorted(s.lstrip(".") for s in (_PROGRAM, *FORMATS)))
            raise UseError("E0905", f"the name `{name}` does not tell a format", f"formats: {known}")
    if len(programs) > 1:
        raise UseError("E0914", "the program can be written to one file alone", f"name one {_PROGRAM} file")
    if programs or drawings:
        program = programs[0] if programs else str(Path(drawings[0]).with_suffix(_PROGRAM))
    else:
        program = None
    beside = str(Path(program).with_suffix(".transcript.json")) if program else None
    places = _Places(program, drawings, arguments.transcript or beside)
    for place in (places.program, places.transcript, *drawings):
        if place:
            files.require_directory(place)
    return places


def _language(arguments: argparse.Namespace) -> Language:
    from aidl_lang.tools.llm.aidl import Aidl

    if not arguments.edit:
        return Aidl(is_robust=arguments.robust)
    language = Aidl(world=files.world(arguments.edit), is_robust=arguments.robust)
    return language if arguments.edit == files.STANDARD else replace(language, file=Path(arguments.edit).name)


class _Heard:
    """A line on a terminal that tells how much of a reply has come."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.heard = self.shown = 0

    def __call__(self, attempt: int, text: str) -> None:
        self.heard += len(text)
        if self.heard >= self.shown + 50:
            self.shown = self.heard
            pass_by(f"{self.name}attempt {attempt}: {self.heard:,} characters …")

    def erase(self) -> None:
        pass_by("")
        self.heard = self.shown = 0


def _conversation(
    arguments: argparse.Namespace,
    places: _Places,
    task: Task,
    provider: Provider,
    language: Language,
    number: int,
) -> Generation:
    """Returns one conversation, told and saved as it goes. Raises AidlError without a single reply."""
    from aidl_lang.tools.llm.generation import Settings, generate, to_dict

    name = f"run {number + 1}: " if arguments.runs > 1 else ""
    heard = _Heard(name)

    def of_run(file: str) -> str:
        """Returns `phone.run-3.aidl` beside `phone.aidl`."""
        path = Path(file)
        stem, dot, rest = path.name.partition(".")
        return str(path.with_name(f"{stem}.run-{number + 1}{dot}{rest}")) if arguments.runs > 1 else file

    def save(generation: Generation) -> None:
        if places.transcript is not None:
            document = to_dict(generation, provider.name, language.name)
            data = json.dumps(document, indent=1, ensure_ascii=False).encode() + b"\n"
            files.write(of_run(places.transcript), data)

    def listen(generation: Generation) -> None:
        heard.erase()
        say(f"{name}{_attempt_line(generation)}")
        save(generation)

    asked = sampling(arguments)
    if asked.seed is not None:
        asked = replace(asked, seed=asked.seed + number)
    start = time.perf_counter()
    done = generate(task, provider, language, Settings(arguments.attempts, asked), heard, listen)
    heard.erase()
    if done.failure is not None:
        if done.verdict is None:
            raise AidlError(done.failure)
        show([done.failure])
    save(done)
    say(f"{name}{_outcome(done, time.perf_counter() - start)}")
    if arguments.runs > 1 and places.program and done.verdict is not None:
        files.write(of_run(places.program), done.verdict.program.encode())
    return done


def _attempt_line(generation: Generation) -> str:
    attempt = generation.attempts[-1]
    verdict = attempt.verdict
    if verdict is None:
        return f"attempt {attempt.number}: no whole program ({attempt.reply.finish})"
    codes = list(dict.fromkeys(verdict.codes))
    named = first_few(codes, _CODES, " …")
    parts = [
        "valid" if verdict.ok else "a plan" if verdict.is_partial else f"wrong in {verdict.stage} ({named})"
    ]
    parts += [f"{len(verdict.fixes)} fixed by machine"] * bool(verdict.fixes)
    parts += [f"{len(verdict.missing)} lost"] * bool(verdict.missing)
    return f"attempt {attempt.number}: {', '.join(parts)}"


def _outcome(generation: Generation, seconds: float) -> str:
    usage = generation.usage
    parts = [
        f"{'valid' if generation.ok else 'not valid'} after {counted(len(generation.attempts), 'attempt')}",
        f"{_number(usage.input)} tokens in, {_number(usage.output)} out",
        "cost unknown" if usage.cost is None else f"${usage.cost:.4f}",
        f"{seconds:.1f} s",
    ]
    return ", ".join(parts)


def _number(value: int | None) -> str:
    return "?" if value is None else f"{value:,}"


def _deliver(arguments: argparse.Namespace, places: _Places, generation: Generation, name: str) -> int:
    verdict = generation.verdict
    if verdict is None:
        last = re.sub(r"\s+", " ", generation.attempts[-1].reply.text.strip())
        say(f"{name}no reply held a program; the last one begins: {shortened(last, 80)!r}")
        return 1
    program = verdict.program
    if arguments.edit:
        from aidl_lang.tools.llm.aidl import merge

        assert generation.task.program is not None
        program = merge(generation.task.program, program)
    for title in verdict.fixes:
        say(f"{name}fixed: {title}")
    for phrase in verdict.missing:
        say(f"{name}still missing: {phrase}")
    _write_program(arguments, places, generation, program)
    if not verdict.ok:
        if verdict.compiled is not None:
            show(verdict.compiled.diagnostics)
        say(f"{name}the program is not valid" + (", nothing drawn" if places.drawings else ""))
        return 1
    _draw(places, program, arguments)
    return 0


def _write_program(
    arguments: argparse.Namespace, places: _Places, generation: Generation, program: str
) -> None:
    before = generation.task.program
    if places.program is not None:
        write = files.rewrite if places.program == arguments.edit else files.write
        write(places.program, program.encode())
    elif before is None:
        print(program, end="")
    if before is not None:
        lines = list(
            difflib.unified_diff(
                before.splitlines(), program.splitlines(), arguments.edit, arguments.edit, lineterm=""
            )
        )
        changed = sum(line.startswith(("+", "-")) for line in lines[2:])
        if places.program is None:
            print("".join(f"{line}\n" for line in lines), end="")
        say(f"{places.program or arguments.edit}: {changed} lines of the program differ")


def _draw(places: _Places, program: str, arguments: argparse.Namespace) -> None:
    from aidl_lang import pipeline
    from aidl_lang.common.source import SourceFile

    if not places.drawings:
        return
    assert places.program is not None
    world = files.world(arguments.edit) if arguments.edit else None
    compiled = pipeline.compile(SourceFile(os.path.basename(places.program), program), world)
    for name, data in [(name, compiled.export(Path(name).suffix.lower())) for name in places.drawings]:
        files.write(name, data)


_PACKAGE = "aidl_eval"
"""A distribution of its own, which stands on this one; so it is known by its name alone."""


def register_eval(parser: argparse.ArgumentParser) -> None:
    """`aidl eval`: how well a model does with the language and with subsets of it, over prompts and runs."""
    if find_spec(_PACKAGE) is None:
        raise UseError("E0913", "`aidl eval` needs a package that is not installed", "pip install aidl-eval")
    import_module(f"{_PACKAGE}.command").register(parser)
