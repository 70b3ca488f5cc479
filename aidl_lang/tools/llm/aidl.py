"""AIDL as the language of a conversation: mends, compiles and compares programs, merges changed ones."""

from __future__ import annotations

import difflib
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import zip_longest

from aidl_lang import parser, pipeline
from aidl_lang.checking.subset import Variant
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.records import record
from aidl_lang.common.render import compact
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.export.job import Options
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.parser import parse
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_statement
from aidl_lang.tools.discretion import Programs, Reader
from aidl_lang.tools.llm import generation
from aidl_lang.tools.llm.intent import Ledger, Loss, request
from aidl_lang.tools.llm.messages import Image, Verdict
from aidl_lang.tools.mending import Mended, mend
from aidl_lang.tools.reference import guide

# --- Writes a changed program as a minimal edit of the one before: what is as it was keeps its text.


def merge(before: str, after: str) -> str:
    """The text of `after` with all that it has in common with `before` written as it is there.

    `after` itself where one of the two does not parse, or the result would not mean the same.
    """
    old, new = (parse(SourceFile("part.aidl", text)) for text in (before, after))
    if has_errors(old.diagnostics) or has_errors(new.diagnostics):
        return after
    text = _merged(_of_file(old.module), _of_file(new.module))
    result = parse(SourceFile("part.aidl", text))
    if has_errors(result.diagnostics) or _means(result.module) != _means(new.module):
        return after
    return text


def _means(module: ast.Module) -> list[str]:
    return [_key(statement) for statement in module.statements]


def _key(statement: ast.Statement) -> str:
    """Returns the meaning of a statement: its canonical form, wherever lines were ended."""
    return re.sub(r"\s*\n\s*", " ", format_statement(statement))


@record()
class _Item:
    """A statement in its text: `lead` is what stands before it behind the line above, `tail` after it."""

    node: ast.Statement
    lead: str
    tail: str

    @cached_property
    def key(self) -> str:
        return _key(self.node)

    @property
    def text(self) -> str:
        return self.lead + self.node.span.text + self.tail

    @property
    def subject(self) -> tuple[object, ...]:
        """A key of its subject: two statements of one subject are versions of each other."""
        match self.node:
            case ast.Structure(kind=kind, name=name, indices=indices):
                return kind, name.text, len(indices)
            case ast.Constrain(braces=braces):
                return type(self.node), braces
            case ast.Param(name=name) | ast.Var(name=name) | ast.Let(name=name) | ast.Assign(name=name):
                return type(self.node), name.text
            case ast.ExpressionStatement(value=ast.Call(callee=callee)):
                return type(self.node), callee.text
            case _:
                return (type(self.node),)


_Body = tuple[Sequence[_Item], str]
"""The statements of a file or a block, and the text after the last of them."""


def _body(text: str, statements: Sequence[ast.Statement], start: int, end: int) -> _Body:
    items = []
    for node, after in zip_longest(statements, statements[1:]):
        following = after.span.start if after is not None else end
        line_end = text.find("\n", node.span.end, following)
        stop = node.span.end if line_end < 0 else line_end
        items.append(_Item(node, text[start : node.span.start], text[node.span.end : stop]))
        start = stop
    return items, text[start:end]


def _of_file(module: ast.Module) -> _Body:
    return _body(module.source.text, module.statements, 0, len(module.source.text))


def _of_block(block: ast.Block) -> _Body:
    return _body(block.span.source.text, block.statements, block.span.start + 1, block.span.end - 1)


def _merged(old: _Body, new: _Body) -> str:
    return "".join(_pieces(old[0], new[0])) + old[1]


def _pieces(old: Sequence[_Item], new: Sequence[_Item]) -> Iterator[str]:
    keys = [item.key for item in old], [item.key for item in new]
    matcher = difflib.SequenceMatcher(None, *keys, autojunk=False)
    for kind, i, i_end, j, j_end in matcher.get_opcodes():
        if kind == "equal":
            yield from (item.text for item in old[i:i_end])
        else:
            yield from _versions(old[i:i_end], new[j:j_end])


def _versions(gone: Sequence[_Item], come: Sequence[_Item]) -> Iterator[str]:
    """Yields new statements, each as an edit of the old one of its subject, or of a renamed one."""
    left, subjects = list(gone), {item.subject for item in come}
    for item in come:
        same = (old for old in left if old.subject == item.subject)
        renamed = (o for o in left if type(o.node) is type(item.node) and o.subject not in subjects)
        was = next(same, None) or next(renamed, None)
        if was is None:
            yield item.text
            continue
        left.remove(was)
        lead = was.lead if was.lead.strip() or not item.lead.strip() else item.lead
        yield lead + _version(was.node, item.node) + (item.tail if item.tail.strip() else was.tail)


def _version(old: ast.Statement, new: ast.Statement) -> str:
    blocks = _block(old), _block(new)
    if blocks[0] is None or blocks[1] is None:
        return new.span.text
    pairs = zip((old, new), blocks, strict=True)
    heads = [n.span.source.text[n.span.start : block.span.start] for n, block in pairs if block]
    head = heads[0] if _spaceless(heads[0]) == _spaceless(heads[1]) else heads[1]
    return f"{head}{{{_merged(_of_block(blocks[0]), _of_block(blocks[1]))}}}"


def _block(node: ast.Statement) -> ast.Block | None:
    """Returns the one block of a statement that is a head and a block."""
    blocks = [child for child in ast.children(node) if isinstance(child, ast.Block)]
    return blocks[0] if len(blocks) == 1 and blocks[0].span.text.startswith("{") else None


def _spaceless(text: str) -> str:
    return re.sub(r"\s+", "", text)


# --- AIDL as a language: mends and compiles programs, and compares them with earlier ones.

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
_TURNED = (
    "Somebody will turn the params. Where the drawing changes its kind on the way, say which meaning is "
    "wanted, place parts so that it cannot happen, or let the range end before:"
)
_PLANNED = (
    "Go on: fill in what is empty or says `todo`, within these boxes or better ones. Answer with the whole "
    "program in one ```aidl block."
)


@record()
class Aidl:
    """AIDL or a subset. Programs, called `file`, may import from `world`; None is nowhere."""

    variant: Variant = Variant.FULL
    world: World | None = None
    file: str = "part.aidl"
    suffix: str = ".aidl"
    fences: tuple[str, ...] = ("aidl",)
    helps: bool = True
    """Sure fixes are made; what a program lost is asked for, and put back in the end; one with empty parts is
    a plan, to be continued.
    """
    is_robust: bool = False
    """What changes kind over the ranges of its params is told once it is valid."""

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
        return AidlConversation(self, before)


class AidlConversation:
    """Consecutive programs, with their intents and the answers to them; those of `before` shall stay."""

    def __init__(self, language: Aidl, before: str | None) -> None:
        self.language = language
        self.told: set[str] = set()
        self.asked: Counter[tuple[str, ...]] = Counter()
        self.settings = pipeline.Settings.of(language.variant)
        self.world = language.world and Programs(language.world)
        self.ledger = Ledger(self.world, self.settings)
        if before is not None:
            source = self._source(before)
            self.ledger.note(source, self._compiled(source))

    def judge(self, program: str) -> Verdict:
        source = self._source(program)
        mended = mend(source, self.world, self.settings) if self.language.helps else Mended(source, [])
        compiled = self._compiled(mended.source)
        self.ledger.note(mended.source, compiled)
        verdict = self._verdict(mended.source, compiled, mended.fixes)
        repairs = generation.mended(program, mended.source.text, mended.fixes)
        answer = self._answer(verdict, compiled)
        told = "\n\n".join(part for part in (repairs, answer) if part) if answer else ""
        return replace(verdict, feedback=told)

    def finish(self, verdict: Verdict) -> Verdict:
        """Puts back what was lost and fits; a conflicting constraint only a model or reader gives up."""
        source, fixes = self._source(verdict.program), verdict.fixes
        compiled = verdict.compiled or self._compiled(source)
        self.ledger.note(source, compiled)
        if compiled.ok and self.language.helps:
            text, restored = self.ledger.restore(source)
            if restored:
                source = self._source(text)
                compiled = self._compiled(source)
                self.ledger.note(source, compiled)
                fixes += tuple(f"put back {item}" for item in restored)
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
        is_partial = self.language.helps and compiled.ok and _is_partial(source, compiled)
        distance = (int(not compiled.ok), -generation.STAGES.index(stage) if wrong else 0, int(is_partial))
        numbers: dict[str, float] = {}
        if compiled.model is not None:
            detached = sum(d.code == "W0705" for d in compiled.diagnostics)
            numbers = counted(compiled.model) | {"detached": detached}
        pictures: tuple[Image, ...] = ()
        if is_partial:
            options = Options(pixels=_PIXELS, show=frozenset({"plan", "names"}))
            pictures = (Image("image/png", compiled.export(".png", options)),)
        return Verdict(
            ok=compiled.ok and not is_partial,
            stage=stage,
            feedback="",
            program=source.text,
            fixes=fixes,
            codes=tuple(d.code for d in wrong),
            is_partial=is_partial,
            images=pictures,
            missing=tuple(loss.phrase for loss in missing),
            weight=(*distance, len(wrong), len(missing), len(warnings)),
            numbers=numbers,
            compiled=compiled,
        )

    def _answer(self, verdict: Verdict, compiled: Compiled) -> str:
        """Returns the answer to the model; "" if there is nothing left to ask for."""
        asked = request(self._to_ask_for())
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
        if not said and self.language.is_robust and _TURNED not in self.told:
            from aidl_lang.tools.ranges import turned

            self.told.add(_TURNED)
            if found := compact(turned(compiled)):
                said = f"{_TURNED}\n\n{found}"
        return f"{said}\n\n{_VALID}" if said else ""

    def _to_ask_for(self) -> tuple[Loss, ...]:
        """Returns the missing things that were not asked for too often."""
        losses = tuple(
            loss
            for loss in (self.ledger.missing if self.language.helps else ())
            if self.asked[_what(loss)] < (1 if loss.is_doubtful else _ASKED)
        )
        self.asked.update(map(_what, losses))
        return losses


def _what(loss: Loss) -> tuple[str, ...]:
    """Returns a key that is the same for a loss in all attempts."""
    return loss.kind, *loss.item.home, loss.item.text


def _is_partial(source: SourceFile, compiled: Compiled) -> bool:
    assert compiled.model is not None
    if any(structure.is_empty for structure in compiled.model.root.walk()):
        return True
    return any(isinstance(node, ast.Todo) for node in ast.walk(parser.parse(source).module))


def counted(model: SolvedModel) -> dict[str, float]:
    """Counts structures and constraints of a model, and its degrees of freedom if known."""
    found: dict[str, float] = {
        "structures": sum(1 for _ in model.root.walk()),
        "constraints": len(model.constraints),
    }
    return found if model.degrees is None else found | {"degrees": model.degrees}
