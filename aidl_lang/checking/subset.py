"""Variants of the language with less in them, and the check for constructs that a variant lacks.

Only the program and its imports are checked, never the library: a shape made of constraints there is a
primitive here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from aidl_lang.checking.builtins import EDITS, FINISHES, SIGNATURES
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.types import AnyType, StructureType, TruthType, Type
from aidl_lang.checking.variants import FORBIDDEN, PAPER_NAMES, Construct, Variant, instead, speaks_of_absent
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_WHOLE = frozenset({"E0406", "E0408"})
"""Codes that concern a whole statement: other diagnostics inside it are dropped."""


def check_subset(infer: Inference, variant: Variant) -> list[Diagnostic]:
    """Returns diagnostics for the constructs in a checked program and its imports that its variant lacks."""
    walker = _Walker(infer, variant)
    if FORBIDDEN[variant]:
        for module in infer.resolution.modules:
            walker.module(module)
    return walker.diagnostics


def adapted(diagnostics: Iterable[Diagnostic], variant: Variant) -> list[Diagnostic]:
    """Returns the diagnostics without advice that the variant cannot follow, and without those inside a
    statement that it lacks.
    """
    found = list(diagnostics)
    own = {rule.code for rule in FORBIDDEN[variant].values()}
    if not own:
        return found
    gone = [d.span for d in found if d.code in own & _WHOLE and d.span is not None]
    return [
        d if d.code in own else _advice(d, variant)
        for d in found
        if d.code in own or d.span is None or not any(span.overlaps(d.span) for span in gone)
    ]


def _advice(d: Diagnostic, variant: Variant) -> Diagnostic:
    is_mended = d.fix is not None and any(speaks_of_absent(variant, e.replacement) for e in d.fix.edits)
    hints = [hint for hint in d.hints if not speaks_of_absent(variant, hint)]
    return replace(d, hints=(*hints, *instead(variant, d.code)), fix=None if is_mended else d.fix)


class _Walker:
    """Reports every construct in files that the variant lacks."""

    def __init__(self, infer: Inference, variant: Variant) -> None:
        self.infer = infer
        self.rules = FORBIDDEN[variant]
        self.root: ast.Structure | None = None
        self.diagnostics: list[Diagnostic] = []

    def module(self, module: ast.Module) -> None:
        roots = [s for s in module.statements if isinstance(s, ast.Structure) and s.parameters is None]
        if roots and module is self.infer.resolution.main:
            self.root = roots[0]
            beside = (s for s in module.statements if not isinstance(s, (*ast.DEFINITIONS, ast.Structure)))
            if (first := next(beside, None)) is not None:
                self._report(Construct.LOOSE, first.span, self.root.name.text)
        stack: list[ast.Node] = list(module.statements)
        while stack:
            node = stack.pop()
            if not self._states(node):
                self._look_at(node)
                stack += ast.children(node)

    def _states(self, node: ast.Node) -> bool:
        """Reports a statement of constraints as a whole. Returns whether it is one."""
        match node:
            case ast.Constrain() | ast.Prefer():
                return self._report(Construct.CONSTRAINT, node.span)
            case ast.ExpressionStatement(value) if self._constrains(value):
                return self._report(Construct.CONSTRAINT, node.span)
            case ast.ConstraintDefinition(name=name):
                return self._report(Construct.DEFINITION, node.span, name.text)
            case _:
                return False

    def _constrains(self, value: ast.Expression) -> bool:
        """Tells whether a bare expression is a constraint; a call that no overload fits is judged by its
        name.
        """
        kind = self._type(value)
        if not isinstance(value, ast.Call):
            return isinstance(kind, TruthType)
        name = self.infer.resolution.canonical.get(value.callee, value.callee.text)
        if name in EDITS | FINISHES:
            return False
        may_be = isinstance(kind, AnyType) and self._may_call(value, ast.ConstraintDefinition)
        return isinstance(kind, TruthType) or may_be or name == "fixed"

    def _look_at(self, node: ast.Node) -> None:
        if Construct.BEYOND in self.rules:
            self._beyond(node)
        match node:
            case ast.Structure(name=name) if node is not self.root:
                construct = Construct.HOLE if node.kind == "hole" else Construct.STRUCTURE
                construct = Construct.TEMPLATE if node.parameters is not None else construct
                self._report(construct, name.span, name.text)
            case ast.ShapeDefinition(name=name):
                self._report(Construct.SHAPE, name.span, name.text)
            case ast.Var(name=name):
                word = Span(node.span.source, node.span.start, node.span.start + len("var"))
                self._report(
                    Construct.UNKNOWN,
                    name.span,
                    name.text,
                    Fix("make it a `let`", (Edit(word, "let"),), is_sure=True),
                )
            case ast.Call(callee=callee):
                if isinstance(self._type(node), StructureType) and self._may_call(node, ast.Structure):
                    self._report(Construct.TEMPLATE, callee.span, callee.text)
                elif isinstance(self._type(node), TruthType) and self._may_call(
                    node, ast.ConstraintDefinition
                ):
                    self._report(Construct.RELATION, callee.span, callee.text)
                self._smooth(node)
            case _:
                pass

    def _beyond(self, node: ast.Node) -> None:
        """Reports what the paper on AIDL has not: calls of the library, attributes, wishes, assertions."""
        match node:
            case ast.Call(callee=callee):
                name = self.infer.resolution.canonical.get(callee, callee.text)
                candidates = self.infer.resolution.candidates.get(node, ())
                is_ours = name in SIGNATURES or any(s.standard for s in candidates)
                if is_ours and name not in PAPER_NAMES and all(s.standard for s in candidates):
                    self._report(Construct.BEYOND, callee.span, callee.text)
            case ast.Attribute(name=name) if name.text not in ("orientation", "allow"):
                self._report(Construct.BEYOND, node.span, f"@{name.text}")
            case ast.Prefer() | ast.Assert():
                word = "prefer" if isinstance(node, ast.Prefer) else "assert"
                self._report(Construct.BEYOND, node.span, word)
            case _:
                pass

    def _smooth(self, call: ast.Call) -> None:
        """Reports `smooth: true` on a step of a path, which lets the solver turn it."""
        candidates = self.infer.resolution.candidates.get(call, ())
        if not any(s.standard and "smooth" in s.by_fold for s in candidates):
            return
        for argument in call.arguments:
            is_off = isinstance(argument.value, ast.Boolean) and not argument.value.value
            if argument.name is not None and fold(argument.name.text) == "smooth" and not is_off:
                self._report(Construct.SMOOTH, argument.span, argument.span.one_line)

    def _type(self, node: ast.Expression) -> Type | None:
        fact = self.infer.facts.get(node)
        return fact.type if fact is not None else None

    def _may_call(self, node: ast.Call, kind: type[ast.Callable]) -> bool:
        return any(s.kind is kind for s in self.infer.resolution.candidates.get(node, ()))

    def _report(self, construct: Construct, span: Span, name: str = "", fix: Fix | None = None) -> bool:
        """Reports a construct that the variant lacks; false if it has it."""
        if (rule := self.rules.get(construct)) is not None:
            message, hint = (text.replace("{name}", name) for text in (rule.message, rule.hint))
            self.diagnostics.append(Diagnostic(rule.code, message, span, hints=(hint,), fix=fix))
        return construct in self.rules
