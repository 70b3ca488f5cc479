"""Diagnostics for calls that no overload fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.checking.binding import PAIRS, PARAMETERS, in_order, select
from aidl_lang.checking.complaints import did_you_mean, respell
from aidl_lang.checking.facts import body_of, is_number, is_point
from aidl_lang.checking.rules import place_before, shown
from aidl_lang.checking.types import (
    Binding,
    GeometryType,
    Given,
    GivenArgument,
    ListType,
    Mismatch,
    NumberType,
    PointType,
    Signature,
    StructureType,
    accepts,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import WORDS, fold, is_slip, nearest
from aidl_lang.common.prose import ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference

Misses: TypeAlias = Sequence[Mismatch]


def no_overload(
    check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], given: Given, misses: Misses
) -> None:
    for answer in _ANSWERS:
        if answer(check, node, given, misses):
            return
    name = node.callee.text
    closest = max(misses, key=lambda m: _closeness(m, given))
    at: ast.Node = node.callee
    if closest.argument is not None and closest.argument < len(nodes):
        at = nodes[closest.argument]
    others = [m.signature for m in misses if m is not closest]
    hints = [*_between_ends(check, node, nodes), *_called_as([closest.signature, *others[:2]])]
    label, centre = f"in this call of `{name}`", _centre(at, given, misses, closest)
    check.report("E0311", f"`{name}` {closest.reason}", at, label=label, hints=hints, fix=centre)


def _centre(at: ast.Node, given: Given, misses: Misses, closest: Mismatch) -> Fix | None:
    """Returns the fix that names the centre of a shape where a point is wanted, if the call fits with it."""
    if closest.kinds is None or closest.argument is None:
        return None
    if not isinstance(at, ast.Name | ast.Member | ast.Index):
        return None
    wanted, kind = closest.kinds
    points = [*given]
    points[closest.argument] = replace(given[closest.argument], type=wanted)
    fits = isinstance(select([m.signature for m in misses], points), Binding)
    if not fits or not isinstance(wanted, PointType) or not isinstance(kind, GeometryType | StructureType):
        return None
    text = f"{at.span.text}.center"
    return Fix(f"write `{text}`", (Edit(at.span, text),))


def _between_ends(check: Inference, node: ast.Call, nodes: Sequence[ast.Expression]) -> list[str]:
    """Returns the hint for an angle or a direction of two points, or of a shape between two, and no line."""
    facts = [check.fact(each) for each in nodes[:2]]
    if len(facts) == 2 and all(is_point(fact.type) for fact in facts):
        (start, end), rest = map(shown, nodes[:2]), nodes[2:]
    elif facts and facts[0].of is not None and {"start", "end"} <= body_of(check, facts[0].of).values.keys():
        start, end = (f"{shown(nodes[0])}.{name}" for name in ("start", "end"))
        rest = nodes[1:]
    else:
        return []
    match check.called(node):
        case "angle" if all(is_number(check.fact(each).type) for each in rest[:1]) and len(rest) < 2:
            way = shown(rest[0]) if rest else "angle"
            return [f"to direct one point from another: `{end} == {start} + polar(length, {way})`"]
        case "direction" if not rest:
            return [f"the direction from one point to another is `unit({end} - {start})`"]
    return []


def _called_as(signatures: Sequence[Signature]) -> list[str]:
    """Returns hints that show how a callable is called: its signatures and the first example among them."""
    hints = [f"{'or as' if i else 'it is called as'} `{s}`" for i, s in enumerate(signatures)]
    example = next((e for s in signatures if (e := example_of(s)) is not None), None)
    return hints + ([f"for example `{example}`"] if example else [])


def example_of(signature: Signature) -> str | None:
    """Returns the first call in the documentation of a definition, if it stands on one line."""
    doc = getattr(signature.node, "doc", None)
    inside = (doc or "").partition("```aidl")[2].partition("```")[0]
    start = inside.find(f"{signature.name}(")
    if start < 0:
        return None
    depth = 0
    for i, char in enumerate(inside[start:], start):
        depth += (char == "(") - (char == ")")
        if char == "\n" or (char == ")" and depth == 0):
            return inside[start : i + 1] if char == ")" else None
    return None


def _closeness(miss: Mismatch, given: Given) -> tuple[int, int, int, int, int]:
    """Returns how near a candidate comes: named arguments it knows, best by name, then what is missing."""
    names = [g.name for g in given if g.name is not None]
    known = sum(1 for name in names if _knows(miss.signature, name))
    same = sum(1 for name in names if fold(name) in miss.signature.by_fold)
    room = -abs(len(miss.signature.parameters) - len(given))
    return known, same, int(miss.argument is not None), min(0, len(given) - miss.signature.needed), room


def _knows(signature: Signature, word: str) -> bool:
    known = signature.by_fold
    pair = PAIRS.get(fold(word), ("", ""))
    meanings = (word, *PARAMETERS.get(fold(word), ()))
    return any(fold(m) in known for m in meanings) or all(p in known for p in pair)


def _ambiguous(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    """Reports a word or a place that may mean several parameters. Returns whether there is one."""
    miss = next((m for m in misses if m.meanings), None)
    if miss is None or miss.argument is None:
        return False
    argument = node.arguments[miss.argument - (len(given) - len(node.arguments))]
    word = argument.name or argument.value
    names = " or ".join(ticked(miss.meanings))
    message = f"`{shown(word)}` of `{node.callee.text}` could mean {names}"
    hints = [f"write `{name}: {shown(argument.value)}`" for name in miss.meanings]
    check.report("E0344", message, word, label="say which", hints=hints)
    return True


def _filled_twice(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    """Reports arguments without a name that stand for parameters which are named as well: `rectangle(20, 10,
    bottom_center: p)`. Returns whether they would fit by name.
    """
    names = in_order([m.signature for m in misses], given)
    first = len(given) - len(node.arguments)
    loose = [(node.arguments[i - first], name) for i, name in sorted(names.items()) if i >= first]
    if not loose or len(loose) < len(names) or len(names) == len(given):
        return False
    named = [f"{name}: {shown(a.value)}" for a, name in loose]
    edits = tuple(Edit(place_before(a.value), f"{name}: ") for a, name in loose)
    written = next(a.name for a in node.arguments if a.name is not None)
    check.report(
        "E0311",
        f"`{node.callee.text}` counts arguments without a name from its first parameter, "
        f"also where `{written.text}` is named",
        loose[0][0].value,
        label=f"in this call of `{node.callee.text}`",
        hints=[f"name {'it' if len(named) == 1 else 'them'}: `{', '.join(named)}`"],
        fix=Fix(f"write `{', '.join(named)}`", edits, is_sure=True),
    )
    return True


def _loose_coordinates(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    """Reports numbers in place of points: `line(0, 0, 10, 5)`, `circle(0, 0, 5)`. Returns whether it did."""
    if not given or len(given) != len(node.arguments) or any(g.name is not None for g in given):
        return False
    if not all(isinstance(g.type, NumberType) for g in given):
        return False
    for miss in misses:
        points = 0
        for _, kind, _ in miss.signature.parameters:
            if not isinstance(kind, PointType):
                break
            points += 1
        sizes = [kind for _, kind, _ in miss.signature.parameters[points:]]
        rest = [g.type for g in given[2 * points :]]
        needed = sum(1 for _, _, optional in miss.signature.parameters[points:] if not optional)
        if not points or len(given) < 2 * points or not needed <= len(rest) <= len(sizes):
            continue
        if any(accepts(wanted, got) is None for wanted, got in zip(sizes, rest, strict=False)):
            continue
        values = [a.value for a in node.arguments]
        edits, texts = [], [shown(v) for v in values]
        for i in range(0, 2 * points, 2):
            end = values[i + 1].span
            edits += [Edit(place_before(values[i]), "("), Edit(Span(end.source, end.end, end.end), ")")]
            texts[i], texts[i + 1] = f"({texts[i]}", f"{texts[i + 1]})"
        call = f"{node.callee.text}({', '.join(texts)})"
        message = f"a point is written in parentheses: `{call}`"
        label = "takes points, and these are single numbers"
        fix = Fix("put the coordinates in parentheses", tuple(edits), is_sure=True)
        check.report("E0346", message, node.callee, label=label, hints=_called_as([miss.signature]), fix=fix)
        return True
    return False


def _pair_for_one(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    """Reports two sizes in brackets: `square([40, 20])`, `rectangle([40, 20])`. Returns whether it did."""
    pairs = [a for a, g in zip(node.arguments, given, strict=False) if _is_pair(g) and _may_be_size(a)]
    if len(given) != len(node.arguments) or len(pairs) != 1:
        return False
    argument = pairs[0]
    text = shown(argument.value)
    start = argument.name.span.start if argument.name is not None else argument.value.span.start
    span = Span(argument.value.span.source, start, argument.value.span.start)
    sizes = {"width", "height"}
    is_said = any(a.name is not None and fold(a.name.text) in sizes for a in node.arguments)
    takes_two = not is_said and any(sizes <= m.signature.by_fold.keys() for m in misses)
    takes_one = any("size" in m.signature.by_fold for m in misses)
    if takes_two and argument.name is None:
        message = f"the first argument of `{node.callee.text}` is its centre; sizes are named: `size: {text}`"
        hints = _called_as([m.signature for m in misses][:1])
        fix = Fix("name it `size`", (Edit(span, "size: "),), is_sure=len(given) == 1)
        check.report("E0345", message, argument.value, label="read as a point", hints=hints, fix=fix)
    elif takes_one:
        two_sizes(check, node, argument)
    return takes_one or (takes_two and argument.name is None)


def _is_pair(given: GivenArgument) -> bool:
    return isinstance(given.type, PointType) or (isinstance(given.type, ListType) and given.type.length == 2)


def _may_be_size(argument: ast.Argument) -> bool:
    return argument.name is None or fold(argument.name.text) in ("size", "s", "dimensions", "dims")


def _half_or_double(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    for argument in node.arguments:
        if argument.name is None or any(_knows(m.signature, argument.name.text) for m in misses):
            continue
        word = fold(argument.name.text)
        for other, wanted, ratio in (("diameter", "radius", "{} / 2"), ("radius", "diameter", "2 * {}")):
            if word != other and other not in PARAMETERS.get(word, ()):
                continue
            if not any(wanted in m.signature.by_fold for m in misses):
                continue
            text = argument.value.span.text
            text = text if isinstance(argument.value, ast.Number | ast.Name | ast.Member) else f"({text})"
            value = ratio.format(text)
            span = Span(node.span.source, argument.name.span.start, argument.value.span.end)
            message = f"`{node.callee.text}` takes a `{wanted}`, not a {other}"
            fix = Fix(f"write `{wanted}: {value}`", (Edit(span, f"{wanted}: {value}"),), is_sure=True)
            check.report("E0324", message, argument.name, fix=fix)
            return True
    return False


def _not_together(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    """Reports named arguments that some overloads know, but none all of them. Returns whether it did."""
    written = [a.name for a in node.arguments if a.name is not None]
    if len(written) < 2 or any(all(_knows(m.signature, n.text) for n in written) for m in misses):
        return False
    name = node.callee.text
    message = f"`{name}` does not take {' and '.join(ticked(n.text for n in written))} together"
    hints = _called_as([m.signature for m in misses[:5]])
    check.report("E0311", message, written[-1], label=f"in this call of `{name}`", hints=hints)
    return True


def _unknown_parameter(check: Inference, node: ast.Call, given: Given, misses: Misses) -> bool:
    names = list(dict.fromkeys(name for m in misses for name, _, _ in m.signature.parameters))
    taken = {fold(a.name.text) for a in node.arguments if a.name is not None}
    free = [name for name in names if fold(name) not in taken]
    synonyms = {w: m for w, meanings in PARAMETERS.items() for m in meanings if m in free}
    closest = max(misses, key=lambda m: _closeness(m, given)).signature
    written = [a.name for a in node.arguments if a.name is not None]
    wrong = [name for name in written if not any(_knows(m.signature, name.text) for m in misses)]
    for identifier in wrong:
        like = nearest(identifier.text, free, 2)
        fix = respell(identifier, like)
        is_word = len(identifier.text) <= 4 or fold(identifier.text) in WORDS
        if not like and not is_word and (near := nearest(identifier.text, synonyms)):
            like = [synonyms[near[0]]]
            meant = [meaning for meaning in PARAMETERS[near[0]] if meaning in free]
            is_sure = is_slip(fold(identifier.text), near[0]) and meant == like
            fix = Fix(f"write `{like[0]}`", (Edit(identifier.span, like[0]),), is_sure)
        if isinstance(closest.node, ast.Structure) and fold(identifier.text) in ("at", "center"):
            _placed_within(check, node, identifier)
            continue
        hints = _called_as([closest]) if closest.parameters else ["it takes no arguments"]
        if fold(identifier.text) == "length" and {"width", "height"} <= set(names):
            hints = ["its sizes are `width`, from left to right, and `height`, from bottom to top"]
        message = f"`{node.callee.text}` has no parameter `{identifier.text}`" + did_you_mean(like)
        check.report("E0324", message, identifier, hints=() if like else hints, fix=fix)
    return bool(wrong)


def _placed_within(check: Inference, node: ast.Call, identifier: ast.Identifier) -> None:
    """Reports a place among the arguments of a template: it stands behind the call."""
    k = next(k for k, argument in enumerate(node.arguments) if argument.name is identifier)
    argument, text = node.arguments[k], node.span.source.text
    place = f" at {argument.value.span.one_line}"
    if k > 0:
        gone = Span(node.span.source, node.arguments[k - 1].span.end, argument.span.end)
    else:
        end = node.arguments[1].span.start if len(node.arguments) > 1 else argument.span.end
        gone = Span(node.span.source, argument.span.start, end)
    end = node.span.end
    behind = Span(node.span.source, end, end)
    is_free = not text[end:].lstrip().startswith(("at ", "at("))
    check.report(
        "E0324",
        f"`{node.callee.text}` has no parameter `{identifier.text}`: "
        "where a structure stands is said after its call",
        identifier,
        hints=(f"as in `{node.callee.text}(…){place}`, which places its `origin`",),
        fix=Fix("place it behind the call", (Edit(gone, ""), Edit(behind, place))) if is_free else None,
    )


_ANSWERS = (
    _ambiguous,
    _filled_twice,
    _loose_coordinates,
    _pair_for_one,
    _half_or_double,
    _unknown_parameter,
    _not_together,
)


def two_sizes(check: Inference, node: ast.Call, argument: ast.Argument) -> None:
    start = argument.span.start
    name = Span(node.span.source, start, argument.value.span.start)
    message = f"a square has one size; two make a rectangle: `rectangle(size: {shown(argument.value)})`"
    edits = Edit(node.callee.span, "rectangle"), Edit(name, "size: ")
    fix = Fix("make it a rectangle", edits, is_sure=True)
    check.report("E0345", message, argument.value, label="two sizes", fix=fix)
