"""Runs the cases of a spec: what differs from what is written, and the text that would agree."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache, partial

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.render import render
from aidl_lang.common.running import Later
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.geometry.freedom import report
from aidl_lang.pipeline import Facts
from tests.spec.parts import Case, Expectation, Line, Program
from tests.spec.readings import Missing, Reader, shown

WIDTH = 110
"""Columns beyond which an accepted expectation is written below its line."""


@dataclass(frozen=True)
class Problem:
    """What differs, and the line of the file it is about."""

    line: int
    text: str


@dataclass
class Outcome:
    """What came of a case. `accepted` replaces ranges of lines (from 1, end excluded) of the file."""

    problems: list[Problem] = field(default_factory=list)
    accepted: dict[tuple[int, int], list[str]] = field(default_factory=dict)

    def differs(self, line: int, text: str) -> None:
        self.problems.append(Problem(line, text))


def run(case: Case) -> Outcome:
    """Compile the program of a case and compare everything that is written about it."""
    outcome = Outcome()
    if case.fixes is not None and not _check_fix(case, outcome):
        return outcome
    if case.formatted is not None:
        _check_format(case, outcome)
    source, plain = _compiled(case, case.program.text)
    if not case.pending:
        _check_each_fix(case, source, plain.diagnostics, outcome)
    if case.message is not None:
        _check_message(case, [d for d in plain.diagnostics if d.is_error], outcome)
        kept = [d for d in plain.diagnostics if not d.is_error]
        plain = replace(plain, find=Later(None, Facts(kept)))
    own = [e for e in case.expectations if not e.is_variant]
    _check_diagnostics(case, own, plain.diagnostics, source, outcome)
    unexplained = case.message is None and not any(d.is_error for d in plain.diagnostics)
    is_said = any(claim.text.startswith("status:") for e in own for claim in e.claims)
    if not is_said and not plain.ok and unexplained:
        outcome.differs(case.program.at, f"the status is {plain.status}")
    for expectation in case.expectations:
        compiled = _variant(case, expectation, source) if expectation.is_variant else plain
        if expectation.is_variant:
            _check_variant(expectation, compiled.diagnostics, outcome)
        reader = cache(partial(Reader, compiled))
        for claim in expectation.claims:
            _check_claim(claim, compiled, reader, outcome)
    return outcome


def _compiled(case: Case, text: str) -> tuple[SourceFile, pipeline.Compiled]:
    """What comes of a text with the files of a case; a broken one is asked for again by its mended form."""
    return _compiled_with(text, tuple(case.files.items()))


@lru_cache(maxsize=16)
def _compiled_with(text: str, files: tuple[tuple[str, str], ...]) -> tuple[SourceFile, pipeline.Compiled]:
    source = SourceFile("spec.aidl", text)
    return source, pipeline.compile(source, MemoryWorld(dict(files)))


def _variant(case: Case, expectation: Expectation, source: SourceFile) -> pipeline.Compiled:
    limits = {name: int(value) for name, value in expectation.settings("limit").items()}
    settings = pipeline.Settings()
    settings = replace(settings, building=replace(settings.building, **limits))
    return pipeline.compile(source, MemoryWorld(case.files), dict(expectation.settings("set")), settings)


# --- Diagnostics -----------------------------------------------------------------------------------


def headline(d: Diagnostic) -> str:
    return f"{d.severity}[{d.code}]: {d.message}"


def _check_diagnostics(
    case: Case,
    expectations: Sequence[Expectation],
    found: Sequence[Diagnostic],
    source: SourceFile,
    outcome: Outcome,
) -> None:
    """Those with a place against the comments of the program, those without against the `expect` blocks."""
    program = case.program
    placed: dict[int, list[str]] = {}
    loose: list[str] = []
    for d in found:
        if d.span is not None and d.span.source is source:
            placed.setdefault(_owner(program, d.span.line), []).append(headline(d))
        else:
            loose.append(headline(d))
    written = {n: texts for n, texts in program.expected.items() if texts}
    for n in sorted(placed.keys() | written.keys()):
        _compare(written.get(n, []), placed.get(n, []), program.at + n - 1, outcome)
    if placed != written:
        outcome.accepted[program.at, program.at + len(program.lines)] = list(_annotated(program, placed))
    lines = [line for e in expectations for line in e.diagnostics]
    _compare([line.text for line in lines], loose, lines[0].number if lines else program.at, outcome)
    _accept_list(lines, loose, outcome)


def _check_message(case: Case, errors: Sequence[Diagnostic], outcome: Outcome) -> None:
    """The errors of the program as a terminal shows them."""
    assert case.message is not None
    at, written = case.message
    found = "".join(f"{render(d)}\n" for d in errors)
    if found != written:
        outcome.differs(at, f"the message is:\n{found}")
        outcome.accepted[at, at + len(written.splitlines())] = found.splitlines()


def _owner(program: Program, number: int) -> int:
    """A line that held an expectation alone counts to the one above it."""
    while -number in program.expected and number > 1:
        number -= 1
    return number


def _compare(written: Sequence[str], found: Sequence[str], line: int, outcome: Outcome) -> None:
    rest = list(found)
    for text in written:
        if text in rest:
            rest.remove(text)
        else:
            outcome.differs(line, f"does not come: {text}")
    for text in rest:
        outcome.differs(line, f"comes unexpected: {text}")


def _annotated(program: Program, placed: dict[int, list[str]]) -> Iterator[str]:
    """The program with the diagnostics that come, beside their lines or, where that is too wide, below."""
    for n, line in enumerate(program.lines, 1):
        if -n in program.expected:
            continue
        rest = list(placed.get(n, ()))
        if len(rest) == 1 and len(line) + len(rest[0]) + 5 <= WIDTH:
            line = f"{line}  // {rest.pop()}"
        yield line
        indent = line[: len(line) - len(line.lstrip())]
        yield from (f"{indent}// {text}" for text in rest)


def _check_variant(expectation: Expectation, found: Sequence[Diagnostic], outcome: Outcome) -> None:
    """All diagnostics of a variant are written in its block."""
    lines = expectation.diagnostics
    texts = [headline(d) for d in found]
    _compare([line.text for line in lines], texts, expectation.lines[0].number, outcome)
    _accept_list(
        lines or expectation.lines[:1], texts if lines else [expectation.lines[0].text, *texts], outcome
    )


def _accept_list(lines: Sequence[Line], texts: Sequence[str], outcome: Outcome) -> None:
    """Lines that stand one below the other become the texts."""
    if lines and [line.text for line in lines] != list(texts):
        for line in lines[1:]:
            outcome.accepted[line.number, line.number + 1] = []
        outcome.accepted[lines[0].number, lines[0].number + 1] = list(texts)


# --- Claims ----------------------------------------------------------------------------------------


def _check_claim(
    claim: Line, compiled: pipeline.Compiled, reader: Callable[[], Reader], outcome: Outcome
) -> None:
    word, colon, rest = claim.text.partition(":")
    if colon and word in ("status", "dof", "free", "motions", "changed"):
        found = _summary(word, compiled)
        if rest.strip() != found:
            outcome.differs(claim.number, f"`{claim.text}`, but it is `{found}`")
            outcome.accepted[claim.number, claim.number + 1] = [f"{word}: {found}"]
        return
    left, equals, right = claim.text.partition(" == ")
    try:
        holds, value = (False, reader().shown(left)) if right == "?" else reader().holds(claim.text)
    except Missing as reason:
        outcome.differs(claim.number, f"`{claim.text}`: {reason}")
        return
    if not holds:
        outcome.differs(claim.number, f"`{claim.text}`, but it is {value}")
        if equals:
            outcome.accepted[claim.number, claim.number + 1] = [f"{left} == {value}"]


def _summary(word: str, compiled: pipeline.Compiled) -> str:
    if word == "status" or compiled.model is None:
        return compiled.status
    model = compiled.model
    match word:
        case "dof":
            return str(model.degrees)
        case "free":
            return ", ".join(model.mobility().free) or "nothing"
        case "motions":
            return "; ".join(report(model)) or "none"
        case _:
            changes = [f"{c.path} {shown(c.written)} -> {shown(c.solved)}" for c in model.changed]
            return ", ".join(changes) or "nothing"


# --- Fixes and the canonical form --------------------------------------------------------------------


def _check_fix(case: Case, outcome: Outcome) -> bool:
    """The program of a `fixed` block is the one above it with all fixes applied."""
    assert case.fixes is not None
    source, found = _compiled(case, case.fixes.code)
    mended, applied = apply_fixes(source, found.diagnostics)
    if not applied:
        outcome.differs(case.program.at, "the program above offers no fix")
    elif mended != case.program.code:
        outcome.differs(case.program.at, f"the fixes of the program above give:\n{mended}")
        outcome.accepted[case.program.at, case.program.at + len(case.program.lines)] = mended.splitlines()
    return not outcome.problems


def _check_each_fix(case: Case, source: SourceFile, found: Sequence[Diagnostic], outcome: Outcome) -> None:
    """After a fix by itself its finding is gone, there are no more errors, and nothing more gives way but for
    what conflicts are about.
    """
    for d in found:
        text, applied = apply_fixes(source, [d])
        if not applied or (d.code in _CONFLICTS and sum(each.code in _CONFLICTS for each in found) > 1):
            continue
        after = _compiled(case, text)[1].diagnostics
        told = [
            *(["does not mend it"] if _still(d, after) else []),
            *(["brings another error"] if _errors(after) + d.is_error > _errors(found) else []),
            *(
                ["makes something give way"]
                if d.code not in _CONFLICTS and _gave(after) > _gave(found)
                else []
            ),
        ]
        for what in told:
            assert d.fix is not None
            outcome.differs(case.program.at, f"the fix `{d.fix.title}` of {headline(d)} {what}")


_CONFLICTS = frozenset({"E0601", "E0602", "E0605"})
_GAVE_WAY = frozenset({"N0601", "W0601", "W0602"})


def _errors(found: Sequence[Diagnostic]) -> int:
    return sum(d.is_error for d in found)


def _gave(found: Sequence[Diagnostic]) -> int:
    return sum(d.code in _GAVE_WAY for d in found)


def _still(before: Diagnostic, after: Sequence[Diagnostic]) -> bool:
    """Whether the same is said of a program that was mended in one place: what is in front of a finding
    stays where it is, but for what a fix puts there.
    """
    assert before.fix is not None
    assert before.span is not None
    edits = [e for e in before.fix.edits if e.span.end <= before.span.start]
    start = before.span.start + sum(len(e.replacement) - (e.span.end - e.span.start) for e in edits)
    same = [d for d in after if d.code == before.code and d.span is not None and d.span.start == start]
    is_rewritten = any(
        e.span.start <= before.span.start and before.span.end <= e.span.end for e in before.fix.edits
    )
    return any(d.message == before.message or not is_rewritten for d in same)


def _check_format(case: Case, outcome: Outcome) -> None:
    assert case.formatted is not None
    at, written = case.formatted
    found = aidl_lang.format(case.program.code)
    if found != written:
        outcome.differs(at, f"the canonical form is:\n{found}")
        outcome.accepted[at, at + len(written.splitlines())] = found.splitlines()
