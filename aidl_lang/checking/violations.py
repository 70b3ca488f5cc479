"""Validity of references: breaches of its rules, and their fixes: statements moved to another structure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from aidl_lang.checking.binding import select
from aidl_lang.checking.builtins import CONNECTING, DERIVING, FOLLOWED, PATTERNS, PRIMITIVE
from aidl_lang.checking.calls import arguments, operation
from aidl_lang.checking.complaints import used_early
from aidl_lang.checking.facts import NOTHING_READ, Fact, ReadPlace, is_point, of_symbol
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.rules import shown
from aidl_lang.checking.symbols import UNKNOWNS, Symbol, SymbolKind, SymbolScope
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
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Relocation of statements from one structure to another above it: paths, names and the place to write.

Written: TypeAlias = Mapping[ast.Node, tuple[float, float] | float]
_ATOMS = ast.Name | ast.Member | ast.Index | ast.Call | ast.Number | ast.Point | ast.List


def member_path(name: ast.Identifier, indices: Sequence[ast.Expression]) -> str:
    """Returns a name with its indices as it is declared: `finger[i]`."""
    return name.text + "".join(f"[{index.span.text}]" for index in indices)


@record(eq=False)
class StatementSite:
    """A place among the statements of a file.

    homes  the structures around, the file first
    trail  the statements around, outermost first, and whether the place is in the `else` of each
    """

    homes: tuple[ast.Node, ...]
    trail: tuple[tuple[ast.Statement, bool], ...]

    @property
    def home(self) -> ast.Node:
        return self.homes[-1]

    def within(self, statement: ast.Statement) -> StatementSite:
        return StatementSite(self.homes, (*self.trail, (statement, False)))

    def inside(self, structure: ast.Structure) -> StatementSite:
        return StatementSite((*self.homes, structure), self.trail)

    def otherwise(self) -> StatementSite:
        return StatementSite(self.homes, (*self.trail[:-1], (self.trail[-1][0], True)))


class Relocation:
    """A move of expressions from a site to an ancestor of its structure, behind the site's statement."""

    def __init__(self, site: StatementSite, ancestor: ast.Node, infer: Inference) -> None:
        self.site = site
        self.infer = infer
        self.level = site.homes.index(ancestor)
        self.between = site.homes[self.level + 1 :]
        self.scope = infer.resolution.scopes[ancestor]
        nodes: list[ast.Node] = [statement for statement, _ in site.trail]
        self.start = nodes.index(self.between[0]) if self.between else len(nodes) - 1
        self.anchor = nodes[self.start]

    @property
    def is_possible(self) -> bool:
        """False for a site in a template, whose instances stand in many places."""
        return all(isinstance(n, ast.Structure) and n.parameters is None for n in self.between)

    def path(self, to: ast.Node | None = None) -> str:
        """Returns the path from the ancestor to the site's structure or one around it; empty for itself."""
        steps: list[str] = []
        for node in self.between:
            assert isinstance(node, ast.Structure)
            steps.append(member_path(node.name, node.indices))
            if node is to:
                break
        return ".".join(steps)

    def statement(self, text: str) -> str | None:
        """Returns a statement for the ancestor, in the loops and branches that the site is in below it."""
        for node, is_else in reversed(self.site.trail[self.start + 1 :]):
            if isinstance(node, ast.For):
                if (run := self.expression(node.iterable)) is None:
                    return None
                variables = ", ".join(v.text for v in node.variables)
                text = f"for {variables} in {run} {{ {text} }}"
            elif isinstance(node, ast.If):
                if (test := self.expression(node.test)) is None:
                    return None
                text = f"if {f'not ({test})' if is_else else test} {{ {text} }}"
        return text

    def expression(self, node: ast.Node) -> str | None:
        """Returns the text of an expression for the ancestor; None if that cannot name all in it."""
        edits: list[tuple[int, int, str]] = []
        resolution = self.infer.resolution
        for part in ast.walk(node):
            if isinstance(part, ast.Call) and self.scope.called(part.callee.text) is None:
                return None
            if not isinstance(part, ast.Name):
                continue
            if (symbol := resolution.uses.get(part)) is None:
                return None
            if (text := self._name(part, symbol, node)) is None:
                return None
            if text != part.text:
                edits.append((part.span.start, part.span.end, text))
        text = node.span.text
        for start, end, new in sorted(edits, reverse=True):
            text = text[: start - node.span.start] + new + text[end - node.span.start :]
        return text

    def _name(self, node: ast.Name, symbol: Symbol, whole: ast.Node) -> str | None:
        if not self.between:
            return node.text
        match symbol.kind:
            case SymbolKind.WORD | SymbolKind.NAMESPACE:
                return node.text
            case SymbolKind.BUILTIN:
                return self._builtin(node.text)
            case SymbolKind.LOOP:
                here = any(s is symbol.node for s, _ in self.site.trail)
                inside = any(n is symbol.node for n in ast.walk(whole))
                return node.text if here or inside else None
        if symbol.scope is None:
            return self._own_name(node, symbol)
        home = symbol.scope.homes[-1]
        if home in self.between:
            return self._from_below(symbol, symbol.scope, home)
        return node.text if self.scope.value(node.text) is symbol else None

    def _builtin(self, name: str) -> str:
        if name == "self":
            return self.path()
        return f"{self.path()}.{name}" if name in ("origin", "x_axis", "y_axis") else name

    def _own_name(self, node: ast.Name, symbol: Symbol) -> str | None:
        if symbol.node in self.between:
            return self.path(symbol.node)
        found = self.scope.value(node.text)
        return node.text if found is not None and found.node is symbol.node else None

    def _from_below(self, symbol: Symbol, scope: SymbolScope, home: ast.Node) -> str | None:
        """Returns the path of a name declared by a structure between the two; the expression itself if the
        name stands for one over unknowns, or belongs to a turn of a loop.
        """
        if symbol.kind is SymbolKind.ARGUMENT:
            return None
        reads = of_symbol(self.infer, symbol).reads
        is_local = isinstance(scope.owner, ast.For | ast.ForArguments | ast.Block | ast.ArgumentBlock)
        if symbol.kind is SymbolKind.LET and (is_local or reads != NOTHING_READ):
            value = getattr(symbol.node, "value", None)
            if value is None or symbol.is_array or len(symbol.nodes) > 1:
                return None
            text = self.expression(value)
            return text if text is None or isinstance(value, _ATOMS) else f"({text})"
        return f"{self.path(home)}.{symbol.name}"


def insertion_after(statement: ast.Node, text: str) -> tuple[Span, str]:
    """Returns where to write a statement behind another, and how: on a line of its own if nothing follows."""
    source = statement.span.source
    line_number, _ = source.position(statement.span.start)
    line = source.line(line_number)
    indent = line[: len(line) - len(line.lstrip())]
    end = statement.span.end
    stop = source.text.find("\n", end)
    stop = len(source.text) if stop < 0 else stop
    rest = source.text[end:stop].strip().lstrip(";").strip()
    if rest and not rest.startswith(("//", "#")):
        semicolon = source.text[end:stop].lstrip().startswith(";")
        return Span(source, end, end), f"{';' if semicolon else ''} {text}" + ("" if semicolon else ";")
    stop = end + len(source.text[end:stop].rstrip())
    return Span(source, stop, stop), f"\n{indent}{text}"


@record(eq=False)
class FarReference:
    """An expression that reads too far.

    node       the expression (or, of rule 2, the statement) that reads too far
    path       how its structure reaches the number or point that it defines; None if nothing names it
    is_point   it is a point; otherwise a number
    is_size    a number that is kept as written unless it is marked as a guess
    """

    node: ast.Node
    path: tuple[str, ...] | None
    is_point: bool = False
    is_size: bool = False


@record(eq=False)
class Violation:
    """A breach of a rule of validity.

    rule    1 for geometry, 2 for a constraint
    whole   the expression or statement that the target is part of
    far     the places that are out of reach
    """

    rule: int
    target: FarReference
    whole: ast.Node
    far: tuple[ReadPlace, ...]
    site: StatementSite
    infer: Inference

    @property
    def nodes(self) -> tuple[ast.Node, ...]:
        """The expressions whose written values the diagnostic needs."""
        node = self.target.node
        if self.rule == 2:
            return tuple(c for c in ast.children(node) if c in self.infer.facts)
        return self._references() or (node,)

    def _references(self) -> tuple[ast.Node, ...]:
        """Returns, in a loop, the references alone: the rest of the expression differs from turn to turn, and
        stays.

        Empty if the expression is the same in every turn, or is not made of numbers and points.
        """
        uses = self.infer.resolution.uses
        names = (uses.get(n) for n in ast.walk(self.target.node))
        if not any(s is not None and s.kind is SymbolKind.LOOP for s in names):
            return ()
        found = tuple(self._far(self.target.node))
        kinds = [self.infer.facts[node].type for node in found]
        return found if all(isinstance(k, NumberType) or is_point(k) for k in kinds) else ()

    def _far(self, node: ast.Node) -> Iterator[ast.Node]:
        """Yields the outermost names, with their members, that lead too far."""
        fact = self.infer.facts.get(node)
        if fact is not None and not fact.reads & set(self.far):
            return
        if isinstance(node, ast.Name | ast.Member | ast.Index):
            yield node
        else:
            for child in ast.children(node):
                yield from self._far(child)

    @property
    def ancestor(self) -> ast.Node | None:
        """The nearest structure that holds everything that is read; None if it is not in this text."""
        holders = [p.holder for p in self.far]
        if any(holder not in self.site.homes for holder in holders):
            return None
        return min(holders, key=self.site.homes.index)

    def diagnostic(self, written: Written) -> Diagnostic:
        """Returns the diagnostic. `written`: the values of `nodes` at the first guesses, if known."""
        home = _name(self.site.home)
        culprit = next(self._far(self.target.node), self.target.node)  # the name with all its members
        owner = self._owner(culprit)
        stated = "a constraint" if self._operation is None else f"a `{self._operation}`"
        subject = f"{'geometry' if self.rule == 1 else stated} of {home}"
        ancestor = self.ancestor
        relation = self._relation(ancestor) if ancestor is not None else None
        fix = (
            self._fix(relation, ancestor, written) if ancestor is not None and relation is not None else None
        )
        secondary: list[Label] = []
        symbol = self.infer.resolution.uses.get(_root(culprit))
        if symbol is not None and symbol.declarations:
            secondary.append(Label(symbol.declarations[0].span, "declared here"))
        code = "E0401" if self.rule == 1 else "E0402"
        is_itself = owner == f"`{shown(culprit)}`"  # a structure, which is only said to lie outside
        leads = "lies outside it" if is_itself else f"belongs to {owner}"
        message = f"{subject} cannot use `{shown(culprit)}`, which {leads}"
        hints = (self._hint(relation, ancestor, written),)
        return Diagnostic(code, message, culprit.span, f"outside {home}", tuple(secondary), hints, fix)

    @property
    def _operation(self) -> str | None:
        item = self.target.node
        return operation(self.infer, item.value) if isinstance(item, ast.ExpressionStatement) else None

    # --- Words -----------------------------------------------------------------------------------

    def _owner(self, culprit: ast.Node) -> str:
        fact = self.infer.facts.get(culprit)
        far = [p for p in self.far if fact is None or p in fact.reads] or list(self.far)
        place = far[0]
        return _name(place.holder) if not place.below else f"`{'.'.join(place.below)}`"

    def _hint(self, relation: str | None, ancestor: ast.Node | None, written: Written) -> str:
        where = _name(ancestor) if ancestor is not None else "the structure that holds both"
        if self.rule == 2:
            said = f": `{relation}`" if relation is not None else ", and call things there by their paths"
            return f"say it in {where}, which holds both{said}"
        kind = self.infer.fact(self.target.node).type
        if isinstance(kind, GeometryType | StructureType) and not self.target.is_point:
            return f"make the copy in {where}, which holds both"
        if relation is None:
            return f"write a first guess here, and the relation as a constraint in {where}"
        return f"write a first guess here, `{self._guess(written)}`, and in {where} `{relation}`"

    # --- The fix ---------------------------------------------------------------------------------

    def _relation(self, ancestor: ast.Node) -> str | None:
        move = Relocation(self.site, ancestor, self.infer)
        if not move.is_possible:
            return None
        return self._equation(move) if self.rule == 1 else self._moved(move)

    def _equation(self, move: Relocation) -> str | None:
        path, node = self.target.path, self.target.node
        if path is None:
            return None
        if isinstance(node, ast.Call) and node.callee.text in ("fixed", "guess") and node.arguments:
            if node.callee.text == "guess":
                return None
            node = node.arguments[0].value
        if (right := move.expression(node)) is None:
            return None
        if isinstance(node, ast.Conditional):
            right = f"({right})"
        left = ".".join(step for step in (move.path(), *path) if step)
        return move.statement(f"constrain {left} == {right}")

    def _moved(self, move: Relocation) -> str | None:
        if (text := self._said_there(move)) is None:
            return None
        allowing = {a.span.text for n in (self.whole, self.target.node) for a in getattr(n, "allowing", ())}
        return move.statement(" ".join([*sorted(allowing), text]))

    def _said_there(self, move: Relocation) -> str | None:
        """Returns the constraint with everything in it called as the ancestor knows it."""
        match self.target.node:
            case ast.Prefer(value, weight):
                text = move.expression(value)
                if text is None or weight is None:
                    return text and f"prefer {text}"
                heavy = move.expression(weight)
                return heavy and f"prefer {text} weight {heavy}"
            case ast.Equation(left, right):
                sides = move.expression(left), move.expression(right)
                return f"constrain {sides[0]} == {sides[1]}" if None not in sides else None
            case ast.ExpressionStatement(value):
                text = move.expression(value)
                return text and (f"constrain {text}" if self._operation is None else text)
            case _:
                return None

    def _fix(self, relation: str, ancestor: ast.Node, written: Written) -> Fix:
        move = Relocation(self.site, ancestor, self.infer)
        where, text = insertion_after(move.anchor, relation)
        if self.rule == 2:
            what = "the constraint" if self._operation is None else "it"
            edits = Edit(self._emptied().span.with_separator, ""), Edit(where, text)
            return Fix(f"move {what} to {_name(ancestor)}", edits, is_sure=True)
        is_known = self.target.node in written or not self.infer.fact(self.target.node).is_any
        return Fix(
            f"make it a first guess and state the relation in {_name(ancestor)}",
            (Edit(self.target.node.span, self._guess(written)), Edit(where, text)),
            is_sure=is_known,  # otherwise it follows from something wrong, which is mended first
        )

    def _emptied(self) -> ast.Node:
        """Returns the constraint, or the outermost block around it that holds nothing else."""
        inner: ast.Node = self.whole
        around = [s for s, _ in self.site.trail if not isinstance(s, ast.Structure) and s is not inner]
        for statement in reversed(around):
            blocks = [child for child in ast.children(statement) if isinstance(child, ast.Block)]
            span = blocks[0].span
            before, after = (
                Span(span.source, span.start, inner.span.start),
                Span(span.source, inner.span.end, span.end),
            )
            if len(blocks) > 1 or (before.text + after.text).strip(" \t\n;,{}"):
                break
            inner = statement
        return inner

    def _guess(self, written: Written) -> str:
        """Returns the replacement: the value, or in a loop the expression with values for its references."""
        target = self.target.node
        if not (places := self._references()):
            return self._marked(_literal(written.get(target), self.target.is_point, self._fallback))
        text, start = target.span.text, target.span.start
        for node in reversed(places):
            value = _literal(written.get(node), is_point(self.infer.facts[node].type), self._fallback)
            text = text[: node.span.start - start] + value + text[node.span.end - start :]
        return self._marked(text)

    @property
    def _fallback(self) -> float:
        return 10.0 if self.target.is_size else 0.0

    def _marked(self, text: str) -> str:
        return f"guess({text})" if self.target.is_size and not self.target.is_point else text


def _literal(value: tuple[float, float] | float | None, pair: bool, fallback: float) -> str:
    """Returns a number or a point as it was written; the fallback if that is not known."""
    if pair:
        x, y = value if isinstance(value, tuple) else (0.0, 0.0)
        return f"({_digits(x, 0.0)}, {_digits(y, 0.0)})"
    return _digits(value if isinstance(value, float | int) else fallback, fallback)


def _digits(value: float, fallback: float) -> str:
    if not math.isfinite(value):
        value = fallback
    return f"{0.0 if abs(value) < 1e-9 else value:.6g}"


def _name(node: ast.Node) -> str:
    return f"`{node.name.text}`" if isinstance(node, ast.Structure) else "the file's assembly"


def _root(node: ast.Node) -> ast.Node:
    while isinstance(node, ast.Member | ast.Index):
        node = node.value
    return node


# --- Validity of references (language reference: validity): the unknowns that each expression may read.
#
# Rule 1: geometry references only geometry and unknowns of its own structure. Arguments of templates may
# reach further, since the instantiating structure ties them by equalities; geometry derived for good, as by
# `mirror`, `copy` and `offset`, may be made of geometry anywhere further up, of its points and sizes too.
# Rule 2: a constraint references only the subtree of the structure that holds it.
#
# A breach becomes a `Violation`. Its diagnostic names the nearest common ancestor, where the relation can be
# stated, and mends the program: what reads too far becomes a first guess, and the ancestor gets the
# constraint.


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
                target = FarReference(value, (name.text,), is_point(self.infer.fact(value).type))
                self._geometry([target], value, site)
            case ast.For(body=body):
                self.block(body.statements, site)
            case ast.If(then=then, otherwise=otherwise):
                self.block(then.statements, site)
                if otherwise is not None:
                    self.block(otherwise.statements, site.otherwise())
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
            items = ((item, (*path, f"{name}[{i}]")) for i, item in enumerate(node.items))
            return [target for item, place in items for target in self._point(item, place)]
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
        return chosen.parameter_of(index), chosen.kind_of(index) or ANY

    def _is_field(self, call: ast.Call, name: str) -> bool:
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
