"""Feedback to a model on its program: errors, fixes made, remaining motions."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.numbers import short
from aidl_lang.common.prose import counted, first_few, ticked
from aidl_lang.common.render import compact
from aidl_lang.geometry.freedom import report
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.llm.intent.probing import CONTACTS

STAGES = ("syntax", "types", "validity", "solve", "asserts", "contacts", "done")
"""The checks of a program, in order."""

_STAGE_OF = {"01": "syntax", "02": "types", "03": "types", "06": "solve", "08": "validity"}
_ASSERT = "E0604"
_MOST = 12
"""Most motions and boxes in the feedback."""


def stage_of(diagnostics: Iterable[Diagnostic]) -> str:
    """Returns the first stage that fails; remarks on parts that touch nothing fail `contacts`."""
    failing = {_stage(d) for d in diagnostics if d.is_error or d.code in CONTACTS}
    return next((stage for stage in STAGES if stage in failing), "done")


def _stage(diagnostic: Diagnostic) -> str:
    if diagnostic.code == _ASSERT:
        return "asserts"
    if diagnostic.code in CONTACTS:
        return "contacts"
    return _STAGE_OF.get(diagnostic.code[1:3], "validity")


def errors(compiled: Compiled) -> str:
    """Describes the errors and, if the solver failed, the freedom that the rest leaves."""
    wrong = [d for d in compiled.diagnostics if d.is_error]
    stage = stage_of(wrong)
    count = counted(len(wrong), "error")
    blocks = [f"The program is wrong: {count}, the first of them in the check of {stage}.", compact(wrong)]
    if stage == "solve" and compiled.model is not None:
        blocks.append(_freedom(compiled.model))
    return "\n\n".join(blocks)


def remarks(compiled: Compiled, *, may_constrain: bool) -> str:
    """Returns warnings, and structures that nothing ties to the rest; "" if there are none."""
    warnings = [d for d in compiled.diagnostics if d.code.startswith("W")]
    floating = floats(compiled.model) if may_constrain and compiled.model is not None else ()
    blocks = [compact(warnings)] if warnings else []
    if floating:
        names = first_few(ticked(floating), _MOST, ", …")
        verb, stands = ("floats", "it stands") if len(floating) == 1 else ("float", "they stand")
        blocks.append(
            f"warning: {names} {verb}: no constraint speaks of where, so {stands} as first guessed. Say how "
            "parts lie to each other, as in `a.above(b, gap: 2)` or `centered_in(a, b)`"
        )
    return "\n\n".join(blocks)


def floats(model: SolvedModel) -> tuple[str, ...]:
    """Returns paths, without the root, of structures that no constraint places."""
    return tuple(path.removeprefix(f"{model.root.path}.") for path in model.mobility().floating)


def _freedom(model: SolvedModel) -> str:
    degrees = "unknown" if model.degrees is None else str(model.degrees)
    return f"Degrees of freedom left beside these constraints: {degrees}" + "".join(
        f"\n- {each}" for each in report(model, _MOST)
    )


def mended(before: str, after: str, titles: Sequence[str]) -> str:
    """Returns the changes made in the program before it was checked, as lines."""
    if before == after:
        return ""
    counts = ", ".join(
        f"{title} ({n} times)" if n > 1 else title
        for title, n in ((key, len(list(group))) for key, group in groupby(titles))
    )
    return (
        f"These fixes were made to your program already; keep them: {counts}. Lines count as after them.\n"
        + "\n".join(_changed(before.splitlines(), after.splitlines()))
    )


def _changed(before: Sequence[str], after: Sequence[str]) -> Iterator[str]:
    matcher = difflib.SequenceMatcher(None, before, after, autojunk=False)
    for kind, i, i_end, j, j_end in matcher.get_opcodes():
        if kind == "equal":
            continue
        yield from (f"  - {line.strip()}" for line in before[i:i_end])
        yield from (f"  + {number} | {after[number - 1].strip()}" for number in range(j + 1, j_end + 1))


def plan(model: SolvedModel) -> str:
    """Describes the state of a program to be continued: its structures with their boxes."""
    lines = ["So far it compiles. Boxes, in mm, in the frame of the root:"]
    structures = list(model.root.walk())
    lines += [f"- {_box(s)}" for s in structures[: 4 * _MOST]]
    if len(structures) > 4 * _MOST:
        lines.append(f"- and {len(structures) - 4 * _MOST} more")
    return "\n".join(lines)


def _box(structure: SolvedStructure) -> str:
    box = structure.box
    where = (
        f"x {short(box.left, 2)} to {short(box.right, 2)}, y {short(box.bottom, 2)} to {short(box.top, 2)}"
        if box
        else "no extent"
    )
    return f"{structure.kind} `{structure.path}`: {where}" + " (empty)" * structure.is_empty
