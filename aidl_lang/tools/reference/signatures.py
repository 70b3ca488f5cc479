"""Facts read off the syntax tree of a library definition: its call, its named parts, the parameter a
constraint holds, and whether a measure is exact or a least one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from aidl_lang.checking import library, types
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

VALUE = "value"
"""The parameter that a measuring constraint sets: `distance(a, b, value)`."""

_Constraints = tuple[ast.ConstraintDefinition, ...]
_OPTIONS = (VALUE, "about", "axis", "margin", "inset", "by")
"""Parameters that are options even if they take a point or anything."""


def written(node: ast.Callable | ast.Let) -> str:
    """Returns a definition's head in a line, as `ring(center: point = (0, 0), outer_radius: length)`."""
    if isinstance(node, ast.Let):
        return f"{node.name.text} = {node.value.span.one_line}"
    items = ", ".join(" ".join(p.span.text.split()) for p in node.parameters or ())
    return f"{node.name.text}({items})"


@record()
class Part:
    """A named part of a shape or template: `edges[i]` for an array; `type` is "" if that is not known."""

    name: str
    type: str = ""

    def __str__(self) -> str:
        return f"{self.name}: {self.type}" if self.type else self.name


def parts(node: ast.Callable) -> list[Part]:
    """Returns what a body declares for its users, of a function its shape: no `let` that only it uses."""
    if isinstance(node, ast.FunctionDefinition):
        made = made_shape(node)
        shape = library.load().callables[made][0].node if made and made not in types.PUBLIC else None
        return parts(shape) if isinstance(shape, ast.ShapeDefinition) else []
    if not isinstance(node, ast.ShapeDefinition | ast.Structure):
        return []
    found: dict[str, Part] = {}
    used = {n.text for n in ast.walk(node.body) if isinstance(n, ast.Name)}
    for statement, in_loop in _statements(node.body):
        match statement:
            case ast.Assign(construction=True):
                pass
            case ast.Assign(name) | ast.Structure(name=name):
                index = "".join(f"[{letter}]" for letter, _ in zip("ijk", statement.indices, strict=False))
                if index or not in_loop:
                    found.setdefault(name.text, Part(name.text + index, _type(statement)))
            case ast.Let(name) if not in_loop and name.text not in used:
                found.setdefault(name.text, Part(name.text))
            case _:
                pass
    return list(found.values())


def _statements(block: ast.Block, in_loop: bool = False) -> Iterator[tuple[ast.Statement, bool]]:
    """Yields the statements of a body and of its loops and branches, with True inside a loop."""
    for statement in block.statements:
        yield statement, in_loop
        match statement:
            case ast.For(body=body):
                yield from _statements(body, True)
            case ast.If(then=then, otherwise=otherwise):
                yield from _statements(then, in_loop)
                yield from _statements(otherwise, in_loop) if otherwise else ()


def _type(statement: ast.Assign | ast.Structure) -> str:
    if isinstance(statement, ast.Structure):
        return statement.kind
    match statement.value:
        case ast.Point():
            return "point"
        case ast.Call(callee, None) if _is_shape(callee.text):
            return callee.text
        case _:
            return ""


def _is_shape(name: str) -> bool:
    known = library.load().callables.get(name)
    return name in types.PUBLIC or (known is not None and isinstance(known[0].node, ast.ShapeDefinition))


def made_shape(node: ast.FunctionDefinition) -> str | None:
    """Returns the shape or primitive that a function is another way to make; None for one that computes."""
    match node.value:
        case ast.Call(callee, None) if _is_shape(callee.text):
            return callee.text
        case _:
            return None


def things(node: ast.Callable) -> list[ast.Parameter]:
    """Returns the parameters that take related things; the others are options, usually given by name."""
    return [p for p in node.parameters or () if not _is_option(p)]


def _is_option(parameter: ast.Parameter) -> bool:
    kind = types.parameter_type(parameter)
    return (
        parameter.default is not None
        or isinstance(kind, types.NumberType | types.TextType | types.TruthType)
        or parameter.name.text in _OPTIONS
    )


def gathers(node: ast.Callable) -> bool:
    """True if any number of things may be given, because the first parameter is a list."""
    kind = node.parameters[0].type if node.parameters else None
    return kind is not None and types.PARAMETER_TYPES.get(fold(kind.text)) == types.PARAMETER_TYPES["list"]


def held(node: ast.Callable) -> str:
    """Returns in words what is held on the first try; "" for a definition that places nothing."""
    if not isinstance(node, ast.ConstraintDefinition):
        return ""
    if any(p.name.text == VALUE for p in node.parameters):
        return "the value"
    peers = [p.name.text for p in node.parameters if p.type is not None and fold(p.type.text) in types.PEERS]
    if gathers(node) and peers:
        if others := [p.name.text for p in things(node) if p.name.text not in peers]:
            return f"`{others[-1]}`"
        return f"one that is placed, else the last of `{peers[0]}`"
    if peers:
        return f"one that is placed, else `{peers[-1]}`" if len(peers) > 1 else ""
    name = _held_parameter(node, ())
    return "" if name is None else f"the last of `{name}`" if gathers(node) else f"`{name}`"


def _held_parameter(node: ast.ConstraintDefinition, around: _Constraints) -> str | None:
    """Returns the last thing a constraint takes; for one that only calls another, what that one holds."""
    call, related = _delegated(node), [p.name.text for p in things(node)]
    inner = _called(call, node) if call is not None else None
    if call is not None and inner is not None and inner not in around:
        kept = _held_parameter(inner, (*around, node))
        given = [call.receiver] if call.receiver is not None else []
        given += [a.value for a in call.arguments if a.name is None]
        by_name = dict(zip((p.name.text for p in inner.parameters), given, strict=False))
        passed = by_name.get(kept) if kept is not None else None
        return passed.text if isinstance(passed, ast.Name) else None
    return related[-1] if len(related) > 1 or gathers(node) else None


def _delegated(node: ast.ConstraintDefinition) -> ast.Call | None:
    """Returns the call that a definition consists of: it then holds what that one holds."""
    match node.body.statements:
        case (ast.ExpressionStatement(value=ast.Call() as call),):
            return call
        case _:
            return None


def _called(call: ast.Call, caller: ast.ConstraintDefinition) -> ast.ConstraintDefinition | None:
    """Returns the constraint that a call means: the first other one that has all parameters named in it."""
    named = {fold(a.name.text) for a in call.arguments if a.name is not None}
    for signature in library.load().callables.get(call.callee.text, ()):
        node = signature.node
        meant = node is not caller and named <= signature.by_fold.keys()
        if meant and isinstance(node, ast.ConstraintDefinition) and not is_refusal(node):
            return node
    return None


def is_refusal(node: ast.Callable) -> bool:
    """True for a definition that exists only to refuse a call with a reason."""
    call = _delegated(node) if isinstance(node, ast.ConstraintDefinition) else None
    value = call if call is not None else node.value if isinstance(node, ast.FunctionDefinition) else None
    return isinstance(value, ast.Call) and value.callee.text == "refuse"


def exactness(node: ast.Callable) -> dict[str, str]:
    """Returns how a constraint meets each length and angle: `exactly`, `at least` or, by name, `at most`."""
    if not isinstance(node, ast.ConstraintDefinition):
        return {}
    measures = [p.name.text for p in node.parameters if isinstance(types.parameter_type(p), types.NumberType)]
    found = {name: _exactness_of(name, node, ()) for name in measures}
    return {name: word for name, word in found.items() if word}


def _exactness_of(name: str, node: ast.ConstraintDefinition, around: _Constraints) -> str:
    if node in around:
        return ""
    aliases = {name}
    for item in ast.walk(node.body):
        match item:
            case ast.Let(called, value) if _mentions(value, aliases):
                aliases.add(called.text)
            case ast.Comparison() if _mentions(item, aliases):
                return "exactly" if "==" in item.operators else "at most" if "most" in name else "at least"
            case ast.Call(arguments=arguments) if (inner := _called(item, node)) is not None:
                for argument in arguments:
                    if argument.name is not None and _mentions(argument.value, aliases):
                        return _exactness_of(argument.name.text, inner, (*around, node))
            case _:
                pass
    return ""


def _mentions(node: ast.Node, wanted: Iterable[str]) -> bool:
    return any(isinstance(n, ast.Name) and n.text in wanted for n in ast.walk(node))


def relates_boxes(node: ast.ConstraintDefinition, around: _Constraints = ()) -> bool:
    """True if a constraint, or one that it calls, reads the boxes of its arguments."""
    calls = [n for n in ast.walk(node.body) if isinstance(n, ast.Call)]
    if _takes_box(node) or any(_reads_boxes(call.callee.text) for call in calls):
        return True
    inner = [n for call in calls if (n := _called(call, node)) is not None and n not in around]
    return any(relates_boxes(n, (*around, node)) for n in inner)


def _reads_boxes(name: str) -> bool:
    nodes = [signature.node for signature in library.load().callables.get(name, ())]
    return bool(nodes) and all(isinstance(n, ast.FunctionDefinition) and _takes_box(n) for n in nodes)


def _takes_box(node: ast.Callable) -> bool:
    return any(p.type is not None and p.type.text == "box" for p in node.parameters or ())


def split_items(text: str) -> list[str]:
    """Splits items at commas outside of brackets."""
    items, depth, start = [], 0, 0
    for place, char in enumerate(text):
        depth += (char in "([{") - (char in ")]}")
        if char == "," and depth == 0:
            items.append(text[start:place].strip())
            start = place + 1
    return [*items, text[start:].strip()] if text.strip() else []
