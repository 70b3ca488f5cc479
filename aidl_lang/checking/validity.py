"""Validity of references (language reference: validity): the unknowns that each expression may read.

Rule 1: geometry references only geometry and unknowns of its own structure. Arguments of templates may reach
further, since the instantiating structure ties them by equalities; geometry derived for good, as by `mirror`,
`copy` and `offset`, may be made of geometry anywhere further up, of its points and sizes too. Rule 2: a
constraint references only the subtree of the structure that holds it.

A breach becomes a `Violation`. Its diagnostic names the nearest common ancestor, where the relation can be
stated, and mends the program: what reads too far becomes a first guess, and the ancestor gets the constraint.
"""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.checking.binding import select
from aidl_lang.checking.builtins import CONNECTING, DERIVING, FOLLOWED, PATTERNS, PRIMITIVE
from aidl_lang.checking.calls import arguments
from aidl_lang.checking.facts import Fact, ReadPlace, is_point
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.resolving.complaints import used_early
from aidl_lang.checking.resolving.symbols import UNKNOWNS
from aidl_lang.checking.types import (
    ANY,
    Binding,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    StructureType,
    Type,
    given_to,
)
from aidl_lang.checking.violations import FarReference, StatementSite, Violation, member_path
from aidl_lang.syntax import ast


def check_validity(module: ast.Module, infer: Inference) -> list[Violation]:
    """Returns the breaches of both rules in one file."""
    walker = _Walker(infer)
    walker.block(module.statements, StatementSite((module,), ()))
    return walker.found


class _Walker:
    """Collects the breaches in the bodies of structures; a definition's body is judged where it is called."""

    def __init__(self, infer: Inference) -> None:
        self.infer = infer
        self.found: list[Violation] = []

    def block(self, statements: Sequence[ast.Statement], site: StatementSite) -> None:
        for statement in statements:
            self._statement(statement, site.within(statement))

    def _statement(self, node: ast.Statement, site: StatementSite) -> None:
        match node:
            case ast.Structure():
                if node.parameters is None:
                    self._placement(node, site)
                self.block(node.body.statements, site.inside(node))
            case ast.Assign():
                self._assign(node, site)
                self._placement(node, site)
            case ast.Var(name, value):
                made_point = is_point(self.infer.fact(value).type)
                target = FarReference(value, (name.text,), is_point=made_point, is_size=False)
                self._geometry([target], value, site)
            case ast.For(body=body):
                self.block(body.statements, site)
            case ast.If(then=then, otherwise=otherwise):
                self.block(then.statements, site)
                if otherwise is not None:
                    self.block(otherwise.statements, site.otherwise(node))
            case ast.Constrain(items):
                if node.braces:
                    self.block(items.statements, site)
                else:
                    self._constraint(node, items.statements[0], site)
            case ast.ExpressionStatement() | ast.Prefer() | ast.Equation():
                self._constraint(node, node, site)

    # --- Rule 1 --------------------------------------------------------------------------------

    def _assign(self, node: ast.Assign, site: StatementSite) -> None:
        path = (member_path(node.name, node.indices),)
        value = node.value
        match value:
            case ast.Point():
                self._geometry(self._coordinates(value, path), value, site)
            case ast.Call():
                self._made(value, path, site)
            case ast.Conditional(then=then, otherwise=otherwise):
                for branch in (then, otherwise):
                    if isinstance(branch, ast.Call):
                        self._made(branch, None, site)
            case ast.Comprehension():
                if isinstance(element := value.innermost.element, ast.Call):
                    self._made(element, None, site)
            case ast.List(items):
                for item in items:
                    if isinstance(item, ast.Call):
                        self._made(item, None, site)
            case _:
                pass  # a name for an expression is judged where it is used

    def _made(self, call: ast.Call, path: tuple[str, ...] | None, site: StatementSite) -> None:
        """Checks the arguments of a constructor; those of a template may reach anywhere."""
        fact = self.infer.fact(call)
        name = self.infer.called(call)
        if isinstance(fact.type, StructureType) or not self._makes_geometry(fact, name):
            return
        reach = name in DERIVING | PATTERNS
        connects = name in CONNECTING and fact.of is not None and self.infer.is_standard(fact.of)
        derives = (name in DERIVING and not is_point(fact.type)) or connects
        path = None if name in DERIVING else path  # a copy has no parameters to constrain
        for index, node in enumerate(arguments(self.infer, call)):
            found = self.infer.fact(node)
            is_thing = not isinstance(found.type, NumberType | PointType)  # to copy, or a line
            is_made = isinstance(node, ast.Call) and self._makes_geometry(found, node.callee.text)
            if isinstance(node, ast.Call) and is_made and (is_thing or not derives):
                self._made(node, None, site)
                continue
            follows = name in FOLLOWED and self._parameter(call, index)[0] in FOLLOWED[name]
            if (derives or follows or (reach and is_thing)) and _may_derive(found, site.homes):
                self._order(node, site)
                continue
            self._geometry(self._targets(call, index, node, path), node, site)

    def _order(self, node: ast.Expression, site: StatementSite) -> None:
        """Reports an operand of a derivation that is made further down, but for names of this structure."""
        for part in ast.walk(node):
            symbol = self.infer.resolution.uses.get(part)
            if symbol is None or symbol.node is None or symbol.kind not in UNKNOWNS or symbol.is_array:
                continue
            homes = symbol.scope.homes if symbol.scope is not None else None
            is_own = isinstance(part, ast.Name) and homes == site.homes
            made = symbol.node.span
            last = made.start if isinstance(symbol.node, ast.Structure) else made.end
            if not is_own and part.span.source is made.source and part.span.start < last:
                used_early(self.infer.report, part, symbol, "make it of what stands further up")
                return

    def _makes_geometry(self, fact: Fact, name: str) -> bool:
        return isinstance(fact.type, GeometryType) or name in DERIVING | PATTERNS or is_point(fact.type)

    def _targets(
        self, call: ast.Call, index: int, node: ast.Expression, path: tuple[str, ...] | None
    ) -> list[FarReference]:
        """Returns the expressions in an argument that a guess may replace, with the paths that reach them."""
        name, wanted = self._parameter(call, index)
        is_position = self._is_point(node) or (self.infer.fact(node).is_any and is_point(wanted))
        if path is None or name is None or not self._is_field(call, name):
            return [FarReference(node, None, is_position, is_size=True)]
        if isinstance(node, ast.Point):
            return self._coordinates(node, (*path, name))
        if isinstance(node, ast.List) and node.items and self._is_point(node.items[0]):
            items: list[FarReference] = []
            for i, item in enumerate(node.items):
                place = (*path, f"{name}[{i}]")
                items += self._point(item, place)
            return items
        return [FarReference(node, (*path, name), is_position, is_size=not is_position)]

    def _point(self, node: ast.Expression, path: tuple[str, ...]) -> list[FarReference]:
        if isinstance(node, ast.Point):
            return self._coordinates(node, path)
        return [FarReference(node, path, is_point=True)]

    def _coordinates(self, node: ast.Point, path: tuple[str, ...]) -> list[FarReference]:
        """Returns a point as target, or the one coordinate that reads too far: the other stays as it is."""
        if self._reads(node.x) and self._reads(node.y):
            return [FarReference(node, path, is_point=True)]
        return [FarReference(node.x, (*path, "x")), FarReference(node.y, (*path, "y"))]

    def _parameter(self, call: ast.Call, index: int) -> tuple[str | None, Type]:
        """Returns name and type of the parameter that an argument goes to; None and ANY if in doubt."""
        nodes = arguments(self.infer, call)
        given = given_to(call, [self.infer.fact(node).type for node in nodes])
        chosen = select(self.infer.resolution.candidates.get(call, ()), given)
        if not isinstance(chosen, Binding):
            return None, ANY
        meant = chosen.parameter_of(index)
        return meant, next((kind for name, kind, _ in chosen.taken if name == meant), ANY)

    def _is_field(self, call: ast.Call, name: str) -> bool:
        """Tells whether a parameter of a call is also a field of its result."""
        fact = self.infer.fact(call)
        if isinstance(fact.of, ast.ShapeDefinition):
            return True
        return isinstance(fact.type, GeometryType) and name in PRIMITIVE.get(fact.type.kind, ())

    def _is_point(self, node: ast.Expression) -> bool:
        kind = self.infer.fact(node).type
        return is_point(kind) or isinstance(node, ast.List)

    def _placement(self, node: ast.Structure | ast.Assign, site: StatementSite) -> None:
        """Checks `at` and `rotated`, which belong to the structure that holds the one they place."""
        if node.placement is None:
            return
        path = (member_path(node.name, node.indices), "origin")
        if (at := node.placement.at) is not None:
            self._geometry(self._point(at, path), at, site)
        if (rotated := node.placement.rotated) is not None:
            self._geometry([FarReference(rotated, None, is_size=True)], rotated, site)

    def _geometry(self, targets: Sequence[FarReference], whole: ast.Expression, site: StatementSite) -> None:
        """Checks rule 1 for an expression that geometry is made with."""
        own = ReadPlace(site.home)
        for target in targets:
            far = [p for p in self._reads(target.node) if p != own]
            if far:
                self.found.append(Violation(1, target, whole, tuple(far), site, self.infer))

    def _reads(self, node: ast.Node) -> list[ReadPlace]:
        return _sorted(self.infer.fact(node).reads)

    # --- Rule 2 --------------------------------------------------------------------------------

    def _constraint(self, statement: ast.Statement, item: ast.Statement, site: StatementSite) -> None:
        expressions = [e for e in ast.children(item) if e in self.infer.facts]
        reads = {p for e in expressions for p in self.infer.facts[e].reads}
        far = [p for p in _sorted(reads) if p.holder is not site.home]
        if far and isinstance(item, ast.ExpressionStatement | ast.Prefer | ast.Equation):
            self.found.append(Violation(2, FarReference(item, None), statement, tuple(far), site, self.infer))


def _may_derive(fact: Fact, homes: Sequence[ast.Node]) -> bool:
    """Tells whether a thing may be derived of this in the last of the structures `homes`: of geometry
    wherever it is drawn, of a structure only in one that holds it.
    """
    kind = fact.type
    while isinstance(kind, ListType):
        kind = kind.element
    if isinstance(kind, StructureType):
        return all(p.holder in homes and (not p.below or p.holder is homes[-1]) for p in fact.reads)
    return all(p.holder in homes for p in fact.reads)


def _sorted(places: frozenset[ReadPlace] | set[ReadPlace]) -> list[ReadPlace]:
    return sorted(places, key=lambda p: (p.holder.span.start, p.holder.span.end, p.below))
