"""AIDL as the language of a conversation: mends and compiles programs, and compares them with earlier
ones.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import field, replace

from aidl_lang import parser, pipeline
from aidl_lang.checking.subset import Variant
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.export import Options
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_lang.tools.discretion import Programs, Reader
from aidl_lang.tools.llm import generation
from aidl_lang.tools.llm.intent import Ledger, Loss, request
from aidl_lang.tools.llm.messages import Image, Verdict
from aidl_lang.tools.mending import Mended, mend
from aidl_lang.tools.reference.pages import guide

_PIXELS = 512
"""Larger side of the picture of a plan."""
_ASKED = 2
"""Times that the same lost thing is asked for, if it was clearly not meant to go."""

_WRONG = (
    "Mend this without giving up anything the program means: what an error is about is not to be left out, "
    "but to be said in a way that holds. Answer with the whole program in one ```aidl block."
)
_VALID = (
    "The program is valid. What is said above is worth another look: answer with the whole program, changed "
    "or, where it is meant so, as it is, in one ```aidl block."
)
_PLANNED = (
    "Go on: fill in what is empty or says `todo`, within these boxes or better ones. Answer with the whole "
    "program in one ```aidl block."
)


@record()
class Aidl:
    """AIDL or a subset of it. `world` is where programs may import from, None for nowhere, and `file` the
    name of a program there.
    """

    variant: Variant = Variant.FULL
    world: World | None = None
    file: str = "part.aidl"
    suffix: str = ".aidl"
    fences: tuple[str, ...] = ("aidl",)
    mends: bool = True
    """Sure fixes are made by the machine."""
    recovers: bool = True
    """What a program lost of earlier ones is asked for, and put back in the end."""
    plans: bool = True
    """A program with empty structures is a plan, to be continued; else it is taken as it is."""

    @property
    def name(self) -> str:
        return str(self.variant)

    def guide(self) -> str:
        return guide(self.variant)

    def reads(self, text: str) -> bool:
        """True for a text with a root structure that the parser accepts."""
        parsed = parser.parse(SourceFile(self.file, text))
        is_rooted = any(isinstance(statement, ast.Structure) for statement in parsed.module.statements)
        return is_rooted and not has_errors(parsed.diagnostics)

    def conversation(self, before: str | None = None) -> AidlConversation:
        conversation = AidlConversation(self)
        if before is not None:
            conversation.begin_with(before)
        return conversation


@record(frozen=False)
class AidlConversation:
    """Consecutive programs, with their intents and the answers to them."""

    language: Aidl
    told: set[str] = field(default_factory=set)
    asked: Counter[tuple[str, ...]] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.settings = pipeline.Settings.of(self.language.variant)
        self.world = self.language.world and Programs(self.language.world)
        self.ledger = Ledger(self.world, self.settings)

    def begin_with(self, program: str) -> None:
        """Notes the program to be changed, whose intents shall stay."""
        source = self._source(program)
        self.ledger.note(source, self._compiled(source))

    def judge(self, program: str) -> Verdict:
        source = self._source(program)
        mended = mend(source, self.world, self.settings) if self.language.mends else Mended(source, [])
        compiled = self._compiled(mended.source)
        self.ledger.note(mended.source, compiled)
        verdict = self._verdict(mended.source, compiled, mended.fixes)
        repairs = generation.mended(program, mended.source.text, mended.fixes)
        answer = self._answer(verdict, compiled)
        told = "\n\n".join(part for part in (repairs, answer) if part) if answer else ""
        return replace(verdict, feedback=told)

    def finish(self, verdict: Verdict) -> Verdict:
        """Puts back what was lost and fits. A constraint that conflicts is given up only by the model, or the
        reader of its report.
        """
        source, fixes = self._source(verdict.program), verdict.fixes
        compiled = verdict.compiled or self._compiled(source)
        self.ledger.note(source, compiled)
        if compiled.ok and self.language.recovers:
            restored = self.ledger.restore(source)
            if restored.items:
                source = self._source(restored.text)
                compiled = self._compiled(source)
                self.ledger.note(source, compiled)
                fixes += tuple(f"put back {item}" for item in restored.items)
        return self._verdict(source, compiled, fixes)

    def _source(self, program: str) -> SourceFile:
        return SourceFile(self.language.file, program)

    def _compiled(self, source: SourceFile) -> Compiled:
        compiled = pipeline.compile(source, self.world, settings=self.settings)
        return Reader.of(source).compiled(compiled)

    def _verdict(self, source: SourceFile, compiled: Compiled, fixes: tuple[str, ...]) -> Verdict:
        wrong = [d for d in compiled.diagnostics if d.is_error]
        warnings = [d for d in compiled.diagnostics if d.code.startswith("W")]
        stage = generation.stage_of(compiled.diagnostics)
        missing = self.ledger.missing
        is_partial = self.language.plans and compiled.ok and _is_partial(source, compiled)
        distance = (int(not compiled.ok), -generation.STAGES.index(stage) if wrong else 0, int(is_partial))
        picture = (Image("image/png", _picture(compiled)),) if is_partial else ()
        return Verdict(
            ok=compiled.ok and not is_partial,
            stage=stage,
            feedback="",
            program=source.text,
            fixes=fixes,
            codes=tuple(d.code for d in wrong),
            is_partial=is_partial,
            images=picture,
            missing=tuple(loss.phrase for loss in missing),
            weight=(*distance, len(wrong), len(missing), len(warnings)),
            numbers=_numbers(compiled),
            compiled=compiled,
        )

    def _answer(self, verdict: Verdict, compiled: Compiled) -> str:
        """Returns the answer to the model; "" if there is nothing left to ask for."""
        losses = self._to_ask_for()
        asked = request(losses) if losses else ""
        if not compiled.ok:
            return "\n\n".join(filter(None, (generation.errors(compiled), asked, _WRONG)))
        remarks = generation.remarks(
            compiled, may_constrain=self.language.variant is not Variant.NO_CONSTRAINTS
        )
        remarks = remarks if remarks not in self.told else ""
        self.told.add(remarks)
        if verdict.is_partial:
            assert compiled.model is not None
            return "\n\n".join(filter(None, (generation.plan(compiled.model), remarks, asked, _PLANNED)))
        said = "\n\n".join(filter(None, (remarks, asked)))
        return f"{said}\n\n{_VALID}" if said else ""

    def _to_ask_for(self) -> tuple[Loss, ...]:
        """Returns the missing things that were not asked for too often."""
        losses = tuple(
            loss
            for loss in (self.ledger.missing if self.language.recovers else ())
            if self.asked[_what(loss)] < (1 if loss.is_doubtful else _ASKED)
        )
        self.asked.update(map(_what, losses))
        return losses


def _what(loss: Loss) -> tuple[str, ...]:
    """Returns a key that is the same for a loss in all attempts."""
    return loss.kind, loss.path, loss.text


def _is_partial(source: SourceFile, compiled: Compiled) -> bool:
    """True for a program to be continued: it says `todo`, or has empty structures."""
    assert compiled.model is not None
    if any(structure.is_empty for structure in compiled.model.root.walk()):
        return True
    return any(isinstance(node, ast.Todo) for node in ast.walk(parser.parse(source).module))


def _picture(compiled: Compiled) -> bytes:
    return compiled.export(".png", Options(pixels=_PIXELS, show=frozenset({"plan", "names"})))


def _numbers(compiled: Compiled) -> dict[str, float]:
    if compiled.model is None:
        return {}
    return counted(compiled.model) | {"detached": sum(d.code == "W0705" for d in compiled.diagnostics)}


def counted(model: SolvedModel) -> dict[str, float]:
    """Counts structures and constraints of a model, and its degrees of freedom if known."""
    found: dict[str, float] = {
        "structures": sum(1 for _ in model.root.walk()),
        "constraints": len(model.constraints),
    }
    return found if model.degrees is None else found | {"degrees": model.degrees}
