"""Variants of the language with less in them, and the check for constructs that a variant lacks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from enum import StrEnum

from aidl_lang.checking.builtins import EDITS, FINISHES, SIGNATURES, word_set
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.types import AnyType, StructureType, TruthType, Type
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Subsets of the language, which show what hierarchy and what constraints are worth, and what was added.
#
# `no-hierarchy` has one structure, and all geometry and all constraints are in it. A hole in it is cut by an
# operation on outlines (`cut`), which any structure has. `no-constraints` has nothing to solve for:
# everything stands as it is written. `paper` has the primitives, constraints and operators of the paper on
# AIDL, and its solver. All leave the insides of the library's own shapes alone.


class Variant(StrEnum):
    FULL = "full"
    NO_HIERARCHY = "no-hierarchy"
    NO_CONSTRAINTS = "no-constraints"
    PAPER = "paper"


class Construct(StrEnum):
    """A construct that a variant may lack."""

    HOLE = "hole in a structure"
    STRUCTURE = "structure in another or beside it"
    LOOSE = "geometry or constraint beside a structure"
    TEMPLATE = "template"
    SHAPE = "shape of one's own"
    CONSTRAINT = "constraint"
    UNKNOWN = "unknown"
    DEFINITION = "constraint of one's own"
    RELATION = "relation that is checked"
    SMOOTH = "smooth step"
    BEYOND = "what came after the paper"


@record()
class Restriction:
    """The diagnostic for a construct; `{name}` is its name."""

    code: str
    message: str
    hint: str


PAPER_NAMES = word_set(
    "point line arc circle rectangle triangle rounded_rectangle polygon",
    "above below left_of right_of inside centered_in centered_horizontally centered_vertically touching",
    "taller shorter wider narrower same_width same_height same_size",
    "horizontal vertical length radius diameter fixed coincident concentric tangent equal equal_length",
    "equal_radius symmetric parallel perpendicular collinear midpoint on_segment distance",
    "horizontal_distance vertical_distance angle",
    "sin cos asin acos sqrt abs norm min max len range enumerate zip reversed sum str vector",
)
"""What programs may call in `paper`: its primitives, its constraints by the names they have here, its
operators, and what Python gave it besides.
"""

_ONE = "`no-hierarchy` has one structure"
_AS_WRITTEN = "`no-constraints` draws everything as it is written"
_CUT = "cut it out: `body = cut(plate, bore)`"

FORBIDDEN: Mapping[Variant, Mapping[Construct, Restriction]] = {
    Variant.FULL: {},
    Variant.NO_HIERARCHY: {
        Construct.HOLE: Restriction(
            "E0403",
            f"{_ONE}, and `{{name}}` is a hole of its own",
            f"draw its outline in the one structure, and {_CUT}",
        ),
        Construct.STRUCTURE: Restriction(
            "E0403",
            f"{_ONE}, and `{{name}}` is another",
            "write its geometry and constraints straight into the first structure, under names of their own",
        ),
        Construct.LOOSE: Restriction(
            "E0403", f"{_ONE}, and this stands outside `{{name}}`", "write it inside `{name}`"
        ),
        Construct.TEMPLATE: Restriction(
            "E0404",
            f"{_ONE}, and the template `{{name}}` makes more",
            f"repeat geometry in a loop, `for i in 0..3 {{ bore[i] = circle(…) }}`; if it is a hole, {_CUT}",
        ),
        Construct.SHAPE: Restriction(
            "E0405",
            "in `no-hierarchy` all geometry is on one level, and the shape `{name}` has parts of its own",
            "write its parts where it is used, or make it one `path` or `polygon`; `fn` can work out points",
        ),
    },
    Variant.NO_CONSTRAINTS: {
        Construct.CONSTRAINT: Restriction(
            "E0406",
            f"{_AS_WRITTEN} and has no constraints",
            "write where things are and how large: by numbers, `param`s, or parts of geometry above, as in "
            "`center: plate.top_left + (5, -5)`",
        ),
        Construct.UNKNOWN: Restriction(
            "E0407",
            f"{_AS_WRITTEN}, and `{{name}}` is an unknown",
            "name its value by `let`, or make it a `param`",
        ),
        Construct.DEFINITION: Restriction(
            "E0408",
            f"{_AS_WRITTEN}, and `{{name}}` defines a constraint",
            "let a function work out what it ties, as in `fn top_of(a) = a.center + (0, 10)`",
        ),
        Construct.RELATION: Restriction(
            "E0409",
            "`no-constraints` has no relations, and `{name}` is one",
            "compare coordinates or measures, as in `assert lid.bottom >= box.top`",
        ),
        Construct.SMOOTH: Restriction(
            "E0409",
            f"{_AS_WRITTEN}, and `{{name}}` would move a step of the path",
            "give the points of a smooth outline, or use `tangent_arc_to` and `arc_by`, which go on smoothly",
        ),
    },
    Variant.PAPER: {
        Construct.BEYOND: Restriction(
            "E0986",
            "`paper` has what the paper on AIDL describes, and `{name}` came later",
            "draw with `line`, `arc`, `circle`, `rectangle` or `polygon`, cut with `hole`, and constrain",
        )
    },
}

_ABSENT: Mapping[Variant, str] = {
    Variant.NO_HIERARCHY: r"\bhole\b|\btemplate\b|\b(solid|drawing|assembly) \S+ \{|`drawing`",
    Variant.NO_CONSTRAINTS: r"\b(constrain|prefer|var|guess|fixed)\b|\bas a constraint\b|\bfirst guess\b",
}

_INSTEAD: Mapping[tuple[Variant, str], tuple[str, ...]] = {
    (Variant.NO_HIERARCHY, "W0701"): (f"to make it a hole, {_CUT}",),
    (Variant.NO_CONSTRAINTS, "E0401"): (
        "name the value in the structure around both, as in `let middle = (10, 0)`, and use the name in both",
    ),
}
"""The hint of a diagnostic whose own hints advise a construct that the variant lacks."""


def speaks_of_absent(variant: Variant, text: str) -> bool:
    """Tells whether a hint or an edit advises a construct that the variant lacks."""
    pattern = _ABSENT.get(variant)
    return pattern is not None and re.search(pattern, text) is not None


# Only the program and its imports are checked, never the library: a shape made of constraints there is a
# primitive here.

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
    """Returns diagnostics, but no advice that the variant cannot follow, nor in statements it lacks."""
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
    return replace(d, hints=(*hints, *_INSTEAD.get((variant, d.code), ())), fix=None if is_mended else d.fix)


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
        """Tells whether a bare expression is a constraint; a call that fits no overload is judged by name."""
        kind = self._type(value)
        if not isinstance(value, ast.Call):
            return isinstance(kind, TruthType)
        name = self.infer.called(value)
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
                fix = Fix("make it a `let`", (Edit(word, "let"),), is_sure=True)
                self._report(Construct.UNKNOWN, name.span, name.text, fix)
            case ast.Call(callee=callee):
                kind = self._type(node)
                if isinstance(kind, StructureType) and self._may_call(node, ast.Structure):
                    self._report(Construct.TEMPLATE, callee.span, callee.text)
                elif isinstance(kind, TruthType) and self._may_call(node, ast.ConstraintDefinition):
                    self._report(Construct.RELATION, callee.span, callee.text)
                self._smooth(node)

    def _beyond(self, node: ast.Node) -> None:
        """Reports what the paper on AIDL has not: calls of the library, attributes, wishes, assertions."""
        match node:
            case ast.Call(callee=callee):
                name = self.infer.called(node)
                candidates = self.infer.resolution.candidates.get(node, ())
                is_ours = name in SIGNATURES or any(s.standard for s in candidates)
                if is_ours and name not in PAPER_NAMES and all(s.standard for s in candidates):
                    self._report(Construct.BEYOND, callee.span, callee.text)
            case ast.Attribute(name=name) if name.text not in ("orientation", "allow"):
                self._report(Construct.BEYOND, node.span, f"@{name.text}")
            case ast.Prefer() | ast.Assert():
                word = "prefer" if isinstance(node, ast.Prefer) else "assert"
                self._report(Construct.BEYOND, node.span, word)

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
        if (rule := self.rules.get(construct)) is not None:
            message, hint = (text.replace("{name}", name) for text in (rule.message, rule.hint))
            self.diagnostics.append(Diagnostic(rule.code, message, span, hints=(hint,), fix=fix))
        return construct in self.rules
