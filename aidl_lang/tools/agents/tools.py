"""The tools: check, draw, measure and change programs given as text, and read about the language.

A method of `Tools` is a tool: its docstring says to a language model what it is for, the annotations of its
parameters say what they take (`schema` reads both). Nothing is written and nothing is read but what a program
imports. They raise RefusalError for a call that cannot be answered; a program that is wrong is an answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from aidl_lang import pipeline
from aidl_lang.checking.subset import Variant
from aidl_lang.common import resources
from aidl_lang.common.diagnostics import TooLongError, has_errors
from aidl_lang.common.prose import did_you_mean, ticked
from aidl_lang.common.records import record
from aidl_lang.common.render import compact
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.export import OFFERED
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.agents import drawing, results, workspace
from aidl_lang.tools.agents.workspace import RefusalError, Workspace, refusal
from aidl_lang.tools.discretion import Reader
from aidl_lang.tools.mending import Mended, mend

Program: TypeAlias = Annotated[str, "The text of the whole AIDL program."]
Files: TypeAlias = Annotated[
    Mapping[str, str] | None,
    "Files that the program imports: from the name as it stands in the import to the text.",
]
Params: TypeAlias = Annotated[
    Mapping[str, float | str | bool] | None,
    "Values for params of the program, by name or path; those that are not named keep their defaults.",
]
Path: TypeAlias = Annotated[
    str | None, "The dotted path of a structure or a geometry, as telephone.receiver or dial_plate.finger[3]."
]
if TYPE_CHECKING:
    Format: TypeAlias = str
else:
    Format = Literal[tuple(dict.fromkeys(("png", "model", *OFFERED)))]
Formats: TypeAlias = Annotated[
    Sequence[Format], "What to make: png is a picture, model the solved model as JSON, the others are files."
]
_UNSOLVED = "no mistakes found; nothing was solved: `compile` tells whether the constraints hold"
_ONE_KIND = "no mistakes found, and one kind over the range of each param, at the values that were tried"
_WITHOUT_CONFLICT = {
    "wrong": "the program does not get as far as solving",
    "solved": "every constraint holds: there is no conflict",
}


@record()
class Tools:
    workspace: Workspace = field(default_factory=Workspace)

    def check(
        self, program: Program, files: Files = None, ranges: Annotated[bool, "Walk each param too."] = False
    ) -> results.Checked:
        """Find the mistakes in an AIDL program without solving it, each with its place, the reason and, where
        there is one, a fix; also the program with those fixes applied that can mean nothing else. Quick: use
        it after every edit, before compile. With ranges it is solved, and tells at which value of a param a
        solution flips, holes meet or leave their part, or parts begin to overlap.
        """
        source, world = self.workspace.open(program, files)
        settings = self.workspace.limits.settings
        found = world.reader(source).diagnostics(pipeline.check(source, world, settings))
        if ranges and not has_errors(found):
            from aidl_lang.tools.ranges import turned

            _, compiled, reader = self._compiled(program, None, files)
            found = [*compiled.diagnostics, *reader.diagnostics(turned(compiled, seconds=30.0))]
        mended = mend(source, world, settings) if any(d.fix for d in found) else Mended(source, found)
        left_over = world.reader(mended.source).diagnostics(mended.diagnostics)
        blocks = [compact(found) or (_ONE_KIND if ranges else _UNSOLVED)]
        if mended.fixes:
            left = compact(left_over) or "nothing is left to mend"
            blocks += [f"With these fixes: {', '.join(mended.fixes)}.", mended.source.text, f"Then: {left}"]
        return results.Checked(
            not has_errors(found),
            results.findings(found),
            list(mended.fixes),
            mended.source.text if mended.fixes else None,
            results.findings(left_over) if mended.fixes else None,
            text=results.joined(blocks),
        )

    def compile(
        self,
        program: Program,
        params: Params = None,
        files: Files = None,
        formats: Formats = ("png",),
        path: Annotated[
            str | None, "Of the model, only the structure at this dotted path and what is in it."
        ] = None,
        dimensioned: Annotated[bool, "Draw the dimensions of what is sized."] = False,
    ) -> results.Drawn:
        """Solve and draw an AIDL program: its status and diagnostics, a picture, the bodies with their boxes,
        how they lie to each other, and what can still move. Look at the picture: a program that solves need
        not look right.
        """
        _, compiled, reader = self._compiled(program, params, files)
        return drawing.drawn(compiled, reader, formats, path, self.workspace.limits, dimensioned=dimensioned)

    def guide(
        self,
        section: Annotated[str | None, "The heading of one section, as Constraints; all without it."] = None,
        variant: Annotated[
            Literal["full", "no-hierarchy", "no-constraints", "paper"],
            "The guide to a subset of the language.",
        ] = "full",
    ) -> results.Page:
        """The AIDL language on a few pages. Read it before you write the first program."""
        from aidl_lang.tools.reference import guide

        whole = guide(Variant(variant))
        head, *parts = whole.split("\n## ")
        sections = {part.partition("\n")[0].strip(): f"## {part}" for part in parts}
        title = head.partition("\n")[0].lstrip("# ")
        if section is None:
            return results.Page(title, whole, list(sections), text=whole)
        named = next((name for name in sections if name.casefold() == section.strip().casefold()), None)
        if named is None:
            listed = ", ".join(ticked(sections))
            raise refusal("E0944", f"the guide has no section `{section[:100]}`", f"sections: {listed}")
        return results.Page(named, sections[named], list(sections), text=sections[named])

    def search(
        self,
        query: Annotated[str, "A few words, as: round the corners of an outline."],
        limit: Annotated[int, "How many hits at most."] = 6,
    ) -> results.Hits:
        """Find names of the AIDL library (shapes, constraints, functions, words of the language) and codes of
        diagnostics by what they are about, each with its forms and an example.
        """
        found = results.hits(query[:1_000], max(1, min(limit, 50)))
        nothing = "nothing fits; try other words, or read the guide"
        return results.Hits(found, text=results.joined(map(results.told, found)) or nothing)

    def explain(
        self, name: Annotated[str, "A name of the library, a word of the language, or a code as E0301."]
    ) -> results.Page:
        """All there is to say of one name of the AIDL library (forms, parts, what is held, an example), or of
        the code of a diagnostic (the mistake, and the mended program).
        """
        from aidl_lang.tools.reference import entry_blocks
        from aidl_lang.tools.reference.collect import reference

        code = name.strip("[] ").upper()
        if code in resources.codes():
            return results.Page(code, resources.page(code), text=resources.page(code))
        known = reference()
        entry = known.find(name.strip()) or known.misspelt(name.strip())
        if entry is not None:
            text = results.joined(entry_blocks(entry, "#"))
            return results.Page(entry.name, text, text=text)
        hints = did_you_mean([*known.near(name[:100]), *resources.near(code[:100])][:6])
        raise refusal("E0912", f"there is no `{name[:100]}` to tell about", *hints, "`search` finds names")

    def measure(
        self, program: Program, path: Path = None, params: Params = None, files: Files = None
    ) -> results.Measured:
        """Measure what an AIDL program draws: area, perimeter, centroid, box, moments of inertia, the
        thinnest wall and the narrowest gap, volume and mass, of the whole and of each body or of the part at
        a path, and the gaps and overlaps between bodies.
        """
        _, compiled, reader = self._compiled(program, params, files)
        if not compiled.ok:
            raise RefusalError(*compiled.errors)
        found = compiled.surveyed([path] if path else [])
        most = drawing.MOST_LISTED
        pairs = list(found.pairs[:most])
        parts, whole = found.parts[:most], found.whole
        is_all = not found.is_partial and len(found.pairs) <= most
        diagnostics = [*compiled.diagnostics, *reader.diagnostics(found.notes)]
        report = results.joined(
            [
                "\n".join(drawing.measured(part) for part in [whole, *(p for p in parts if p is not whole)]),
                drawing.left_out("bodies", len(found.parts) - len(parts)),
                "\n".join(map(drawing.contact, pairs)) + ("" if is_all else "\n(not all pairs)"),
                compact(diagnostics),
            ]
        )
        return results.Measured(
            results.data(whole.to_dict()),
            [results.data(part.to_dict()) for part in parts],
            pairs,
            is_all,
            list(found.alone[:most]),
            results.findings(diagnostics),
            text=report,
        )

    def edit_param(
        self,
        program: Program,
        name: Annotated[str, "The name or path of the param, as width or bolt.size."],
        value: Annotated[
            float | str | bool,
            "The new default: a number in mm or degrees, or as a text: 20cm, 80 + 20, 1/2in.",
        ],
        files: Files = None,
    ) -> results.Edited:
        """Change the default of a param in the text of an AIDL program and nothing else; solve both versions
        and tell what moved, grew and changed. Refuses a value outside the range of the param.
        """
        source, before, _ = self._compiled(program, None, files)
        if before.status == "wrong":
            raise RefusalError(*before.errors)
        edit = workspace.edit_of(workspace.find(before.knobs, name), source, value)
        text = source.text[: edit.span.start] + edit.replacement + source.text[edit.span.end :]
        changed, after, _ = self._compiled(text, None, files)
        start = edit.span.start
        workspace.require_in_range(after, Span(changed, start, start + len(edit.replacement)))
        changes = _changes(before, after)
        lead = f"line {edit.span.line}: `{edit.span.text}` became `{edit.replacement}`; {after.status}"
        return results.Edited(
            after.ok,
            drawing.status(after),
            text,
            results.Replacement(results.place(edit.span), edit.span.text, edit.replacement),
            changes,
            results.findings(after.diagnostics),
            text=results.joined([lead, changes, compact(after.diagnostics), text]),
        )

    def explain_conflict(
        self, program: Program, params: Params = None, files: Files = None
    ) -> results.Conflicts:
        """Tell why an AIDL program does not solve: the smallest set of constraints that cannot hold together,
        what each would need, edits that mend it and whether the program solves with them, and the degrees of
        freedom that are left. Mend one of them; do not delete constraints. For a program that solves: what is
        redundant, what can move.
        """
        source, world = self.workspace.open(program, files)
        settings = self.workspace.limits.settings
        compiled = world.reader(source).compiled(pipeline.compile(source, world, params, settings))
        remedies = drawing.Remedies(source, world, params, settings)
        found = [remedies.conflict(conflict) for conflict in compiled.conflicts()]
        others = [d for d in compiled.diagnostics if not (found and d.code in drawing.CODES)]
        blocks = [*map(drawing.in_lines, found), drawing.freedom(compiled), compact(others)]
        if not found:
            blocks.insert(0, _WITHOUT_CONFLICT.get(compiled.status, "no conflict could be told apart"))
        return results.Conflicts(
            drawing.status(compiled),
            found,
            compiled.model.degrees if compiled.model else None,
            drawing.motions(compiled),
            results.findings(others),
            text=results.joined(blocks),
        )

    def _compiled(self, program: str, params: Params, files: Files) -> tuple[SourceFile, Compiled, Reader]:
        """Returns the outcome of a program, as far as its sender may see it."""
        source, world = self.workspace.open(program, files)
        reader = world.reader(source)
        compiled = pipeline.compile(source, world, params, self.workspace.limits.settings)
        return source, reader.compiled(compiled), reader


def _changes(before: Compiled, after: Compiled) -> str:
    if not before.status == after.status == "solved":
        which = "before" if before.status != "solved" else "now"
        return f"nothing can be compared: the program does not solve {which}"
    try:
        return str(before.compared(after))
    except TooLongError as reason:
        return f"nothing can be compared: {reason}"
