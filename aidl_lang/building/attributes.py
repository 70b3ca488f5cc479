"""Attributes of structures and geometry: names, arguments and, for `@clip` and `@behind`, effects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import TypeAlias

from aidl_lang.building.coerce import constant
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.functions import color_of
from aidl_lang.building.model import Geometry, Holder, Structure
from aidl_lang.building.state import Env, Interpreter, Reach, Scope
from aidl_lang.building.values import Nothing, Num, TextVal, Value, certain, each_of, holds, kind_of
from aidl_lang.checking import units
from aidl_lang.checking.builtins import ATTRIBUTES, BEHIND, CLIP, IN_FRONT, NAMING, STACKING, WORDED
from aidl_lang.common.colors import css_color
from aidl_lang.common.diagnostics import Label
from aidl_lang.common.names import find
from aidl_lang.common.prose import listed, ticked, with_article
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

# --- What structures are clipped to, outlines or material: `@clip`, read when all geometry is there.


@record()
class Stated:
    """An attribute that names things, its own name, and the scope in which it is read."""

    name: str
    attribute: ast.Attribute
    scope: Scope


def settle_clips_in(it: Interpreter, parent: Structure) -> None:
    """Clips a structure and those in it to its own outlines or itself, before boxes are asked for."""
    for s in (parent, *parent.children):
        if (stated := it.clips.get(s)) is not None and _names_own(stated, parent):
            _settle(it, s, stated)


def _names_own(stated: Stated, parent: Structure) -> bool:
    """Tells whether a clip names geometry that stands in a structure itself, or the structure."""
    values = [argument.value for argument in stated.attribute.arguments]
    if len(values) != 1 or not isinstance(name := values[0], ast.Name):
        return False
    scope = stated.scope.find(name.text)
    named = None if scope is None else scope.values[name.text]
    is_outline = scope is not None and scope.container is parent and isinstance(named, Geometry)
    return is_outline or named is parent


def settle_clips(it: Interpreter) -> None:
    """Gives structures what they are clipped to, if they have not; copies get theirs with the copies."""
    for s, stated in it.clips.items():
        if not s.clip and s.ground is None:
            _settle(it, s, stated)


def _settle(it: Interpreter, s: Structure, stated: Stated) -> None:
    env = Env(stated.scope, s.parent or s, Reach.READ)
    values = [evaluate(it, argument.value, env) for argument in stated.attribute.arguments]
    if any(isinstance(value, Nothing) for value in values):
        return
    match values:
        case [Structure(kind="solid") as solid] if s.kind == "drawing":
            s.ground = solid
        case [Structure(kind="solid") as solid] if made := tuple(_outlines(solid, s)):
            s.clip = made
        case _:
            s.clip = tuple(_outline(it, s, stated, values))


def _outlines(solid: Structure, clipped: Structure) -> Iterator[Geometry]:
    """Yields what a solid is made of, without what is clipped to it and without veils."""
    for part in solid.walk():
        for g in part.own() if part.kind == "solid" and not part.is_within(clipped) else ():
            fades = any(isinstance(v, TextVal) and v.value == "fade" for v in g.attributes.get("shade", ()))
            if not (g.construction or fades or "opacity" in g.attributes):
                yield g


def _outline(it: Interpreter, s: Structure, clip: Stated, values: Sequence[Value]) -> Iterator[Geometry]:
    """Yields the geometry that `@clip` names; reports what is no outline."""
    attribute = clip.attribute
    found = list(each_of(values[0], Geometry)) if len(values) == 1 else []
    if found and all(g.type != "point" and not g.is_nameless for g in found):
        yield from found
        return
    hints = []
    if len(values) == 1:
        written = attribute.arguments[0].value.span.one_line
        if isinstance(values[0], Structure):
            if s.kind == "drawing":
                hints.append("a drawing is also clipped to the material of a solid: `@clip(plate)`")
            outline = next(iter(values[0].geometry), "outline")
            if values[0].geometry or not hints:
                hints.append(f"name the outline in it, as in `@{attribute.name.text}({written}.{outline})`")
        elif found and all(g.type != "point" for g in found):
            hints.append(f"give it a name that is not drawn: `construction outline = {written}`")
        else:
            hints.append(f"`{written}` is {kind_of(values[0])}")
    message = f"`@{attribute.name.text}` takes the name of a closed outline, as in `@{CLIP}(window)`"
    it.report("E0517", message, attribute, hints=hints)


# --- The stated order of drawing: `@behind` and `@in_front`, read when all structures side by side are
# there.


def state_order(it: Interpreter, s: Structure, stated: Stated) -> None:
    """Keeps what is said of the order of a structure until all beside it are there."""
    if s.parent is None:
        message = f"`{s.name}` is the whole drawing: nothing is beside it"
        hint = f"`{stated.attribute.span.one_line}` stands before a structure in `{s.name}`"
        it.report("E0521", message, stated.attribute, hints=[hint])
    else:
        it.orders.setdefault(s, []).append(stated)


Stacking: TypeAlias = dict[Structure, dict[Structure, ast.Attribute]]
"""Structures, those in front of each, and the attribute that says so."""


def settle_order(it: Interpreter, parent: Structure) -> None:
    """Gives the structures in one that was run the names of those that they are behind or in front of."""
    stated: Stacking = {}
    for s in parent.children:
        if s.source is not None:
            _take_over(it, s, s.source, stated)
        if s in it.orders:
            _read_order(it, s, stated)
    if cycle := _cycle(stated):
        _report_cycle(it, cycle, stated)


def _read_order(it: Interpreter, s: Structure, stated: Stacking) -> None:
    names: dict[str, list[str]] = {}
    for order in it.orders[s]:
        attribute, env = order.attribute, Env(order.scope, s.parent or s, Reach.READ)
        values = [evaluate(it, a.value, env) for a in attribute.arguments]
        if any(isinstance(value, Nothing) for value in values):
            continue
        others = [list(each_of(value, Structure)) for value in values]
        if not others or not all(others):
            taken = f"takes the names of structures beside it, as in `@{order.name}(wall)`"
            it.report("E0517", f"`@{attribute.name.text}` {taken}", attribute)
            continue
        for other in (o for group in others for o in group if o is not s or len(group) == 1):
            if other.parent is not s.parent or other is s:
                _cannot_lie(it, s, other, order)
                continue
            names.setdefault(order.name, []).append(other.name)
            back, front = (s, other) if order.name == BEHIND else (other, s)
            stated.setdefault(back, {})[front] = attribute
    for name, found in names.items():
        s.attributes[name] = tuple(map(TextVal, dict.fromkeys(found)))


def _cannot_lie(it: Interpreter, s: Structure, other: Structure, order: Stated) -> None:
    hints = ["the order is stated between structures that stand side by side in one structure"]
    if other is s:
        why = f"`{s.name}` cannot be {_SIDES[order.name]} itself"
        hints = ["name another structure beside it"]
    elif s.is_within(other):
        why = f"`{s.name}` is a part of `{other.name}`, and parts are drawn on the whole"
    elif other.is_within(s):
        why = f"`{other.name}` is a part of `{s.name}`, and parts are drawn on the whole"
    else:
        why = f"`{other.name}` is not beside `{s.name}`"
        children = s.parent.children if s.parent is not None else ()
        if (beside := next((c for c in children if other.is_within(c)), None)) is not None:
            hints = [f"all of `{beside.name}` is drawn together: `@{order.name}({beside.name})`"]
    it.report("E0521", why, order.attribute, hints=hints)


def _take_over(it: Interpreter, s: Structure, source: Structure, stated: Stacking) -> None:
    """Leaves to a copy what is said of its source, not of itself, and holds beside the copy, too."""
    beside = {child.name: child for child in s.parent.children if child is not s} if s.parent else {}
    own = {order.name for order in it.orders.get(s, ())}
    for name in STACKING:
        values = source.attributes.get(name, ()) if name not in own else ()
        kept = tuple(v for v in values if isinstance(v, TextVal) and v.value in beside)
        s.attributes.pop(name, None)
        if not kept:
            continue
        s.attributes[name] = kept
        attribute = _said(it, source, name)
        for value in kept:
            back, front = (s, beside[value.value]) if name == BEHIND else (beside[value.value], s)
            stated.setdefault(back, {})[front] = attribute


def _said(it: Interpreter, s: Structure, name: str) -> ast.Attribute:
    """Returns the attribute of a name that was written of a structure, or of what it is a copy of."""
    said = (order.attribute for order in it.orders.get(s, ()) if order.name == name)
    return next(said, None) or _said(it, certain(s.source, Structure), name)


def _cycle(stated: Stacking) -> list[Structure]:
    """Returns structures each behind the next, and the last behind the first; none if there are none."""
    order: TopologicalSorter[Structure] = TopologicalSorter()
    for back, fronts in stated.items():
        for front in fronts:
            order.add(front, back)
    try:
        order.prepare()
    except CycleError as e:
        found: list[Structure] = e.args[1]
        return found[:-1]
    return []


def _report_cycle(it: Interpreter, cycle: list[Structure], stated: Stacking) -> None:
    rest = [*cycle[1:], cycle[0]]
    attributes = [stated[back][front] for back, front in zip(cycle, rest, strict=True)]
    chain = ", which is behind ".join(f"`{s.name}`" for s in rest)
    message = f"`{cycle[0].name}` would be behind itself: it is behind {chain}"
    hint = f"leave one of {listed(f'`{a.span.one_line}`' for a in attributes)} out"
    others = [Label(a.span, "and this") for a in attributes[1:]]
    it.report("E0521", message, attributes[0], hints=[hint], secondary=others)


_SIDES = {BEHIND: "behind", IN_FRONT: "in front of"}


FILLING = ("color", "shade")
OF_AREAS = (*FILLING, "opacity", "stroke")
"""What an area has for itself: a closed geometry with a filling, or a solid in a solid with one."""
_LINE_LOOKS = ("color", "stroke", "dash", "opacity", "shade")
OWN_LOOKS = {"drawing": _LINE_LOOKS, "solid": OF_AREAS, "assembly": OF_AREAS}
"""Attributes that a geometry may have for itself, by the kind of its structure."""


def read_attributes(
    it: Interpreter, s: Structure, attributes: Iterable[ast.Attribute], scope: Scope, body: Scope
) -> None:
    """Reads the attributes that the checker has accepted; `@clip` is read in the scope of the body."""
    for name, values, attribute in _read(it, attributes, Env(scope, s.parent or s)):
        if name in STACKING:
            state_order(it, s, Stated(name, attribute, scope))
        elif name == CLIP:
            it.clips[s] = Stated(
                CLIP, attribute, body
            )  # until all geometry is there; of two the later counts
            s.attributes[CLIP] = tuple(TextVal(a.value.span.one_line) for a in attribute.arguments)
        elif _fits(it, name, values, attribute) and _shows(it, name, attribute, s):
            s.attributes[name] = tuple(values)


def read_own_attributes(it: Interpreter, node: ast.Assign, value: Value, env: Env) -> None:
    """Reads the attributes of a geometry; reports those for structures only."""
    things, here = list(each_of(value, Geometry)), env.here
    for name, values, attribute in _read(it, node.attributes, env):
        is_own = here is env.holder and name in OWN_LOOKS.get(here.kind, ())
        if not things or not (name == "note" or is_own):
            _misplaced(it, node, attribute, value, env.holder)
        elif _fits(it, name, values, attribute) and _shows(it, name, attribute, here):
            for thing in things:
                thing.attributes = thing.attributes | {name: tuple(values)}


def _misplaced(
    it: Interpreter, node: ast.Assign, attribute: ast.Attribute, value: Value, container: Holder
) -> None:
    written, thing = attribute.span.one_line, node.name.text
    if not any(each_of(value, Geometry)):
        what = "there already" if holds(value, Structure) else "no part of the drawing"
        why, hint = f"`{thing}` is {what}", "put it before the definition of what it is about"
    elif isinstance(container, Geometry):
        why = f"`{thing}` is a part of the shape `{container.type}`"
        hint = f"put `{written}` before the structure that draws the shape"
    else:
        kind = container.kind if container.kind in ("drawing", "hole") else "solid"
        why = f"`{thing}` is geometry of {container.kind} `{container.name}`"
        hint = (
            f"put it before `{container.name}`, or make `{thing}` a part of its own: "
            f"`{written} {kind} {thing} {{ outline = {node.value.span.one_line} }}`"
        )
    it.report("E0520", f"`@{attribute.name.text}` is said of a structure, and {why}", attribute, hints=[hint])


def _read(
    it: Interpreter, attributes: Iterable[ast.Attribute], env: Env
) -> Iterator[tuple[str, list[Value], ast.Attribute]]:
    """Yields attributes with the values of their arguments; those that name things are read later."""
    for attribute in attributes:
        name = find(attribute.name.text, dict.fromkeys(ATTRIBUTES))
        if name is None or name == ast.ALLOW:
            continue
        values: list[Value] = []
        for argument in attribute.arguments if name not in NAMING else ():
            values.append(_argument(it, name, argument.value, env))
        yield "color" if name == "colour" else name, values, attribute


def _argument(it: Interpreter, name: str, argument: ast.Expression, env: Env) -> Value:
    """Returns the value of an argument; a word of the attribute is meant where its namesake is no text."""
    if name not in WORDED or not isinstance(argument, ast.Name):
        return evaluate(it, argument, env)
    word = TextVal(argument.text)
    if argument not in it.program.resolution.uses:
        return word
    value = evaluate(it, argument, env)
    return word if argument.text in _WORDS.get(name, ()) and not isinstance(value, TextVal) else value


ORIENTATIONS = ("top", "front", "side")
THINNEST, WIDEST = 0.01, 1000.0
"""mm, of lines, dashes and gaps that can be seen."""
MOST = 1000
"""Pieces of a part."""
EDGES = ("seams", "outline")
SHADES = ("round", "ball", "slope", "fade", "none")
NO_OUTLINE = TextVal("none")
"""What `@stroke` says of solids and areas without outline; a width of 0 says the same."""
_WORDS = {"orientation": ORIENTATIONS, "edges": EDGES, "shade": SHADES, "stroke": (NO_OUTLINE.value,)}
"""The words of attributes."""


def _fits(it: Interpreter, name: str, values: list[Value], attribute: ast.Attribute) -> bool:
    """Tells whether an attribute has fitting arguments, and corrects the spelling of an orientation."""
    if any(isinstance(value, Nothing) for value in values):
        return False
    if name == "color":
        return color_of(it, values, attribute) is not None
    what = f"the argument of `@{attribute.name.text}`"
    if any(constant(it, value, attribute, what) is None for value in values if isinstance(value, Num)):
        return False
    if wanted := _WANTED[name](values):
        it.report("E0517", f"`@{attribute.name.text}` takes {wanted}", attribute)
    return not wanted


def _shows(it: Interpreter, name: str, attribute: ast.Attribute, of: Structure) -> bool:
    """Tells whether a look is one of such a structure; a drawing is nothing but its strokes."""
    written, is_flat, wrong, hint = attribute.span.one_line, of.kind in ("drawing", "hole"), "", ""
    if (name in ("edges", "shadow") and is_flat) or (name == "halo" and of.kind == "hole"):
        has = "material or strokes" if name == "halo" else "material"
        wrong = f"is said of what has {has}, and `{of.name}` is a {of.kind}"
        hint = f"leave `{written}` out, or put it before a `solid` or an `assembly`"
    elif name == "quantity" and is_flat:
        wrong = f"is said of parts to be made, and `{of.name}` is a {of.kind}"
        hint = f"put `{written}` before a `solid` or an `assembly`"
    elif name == "depth" and of.kind != "hole":
        wrong = f"is said of holes, and `{of.name}` is {with_article(of.kind)}"
        hint = "make it a `hole`: what it encloses is taken away down to that depth"
    if wrong:
        it.report("E0517", f"`@{attribute.name.text}` {wrong}", attribute, hints=[hint])
    return not wrong


def _worded(words: Sequence[str], wanted: str) -> Callable[[list[Value]], str]:
    return lambda values: "" if _is_one_of(values, words) else wanted


def _is_one_of(values: list[Value], words: Sequence[str]) -> bool:
    word = values[0] if len(values) == 1 else None
    meant = find(word.value, dict.fromkeys(words)) if isinstance(word, TextVal) else None
    if meant is not None:
        values[:] = [TextVal(meant)]
    return meant is not None


def _depth(values: list[Value]) -> str:
    length, taper = _numbers(values[:1], units.LENGTH), _numbers(values[1:], units.ANGLE)
    wanted = "a length above 0, and for a cone its angle, as in `@depth(2mm)` or `@depth(2mm, 90deg)`"
    if not length or taper is None or len(taper) > 1:
        return wanted
    return "" if length[0] > 0 and all(0 < angle < 180 for angle in taper) else wanted


def _one_number(dimension: units.Dimension, fits: Callable[[float], bool], wanted: str) -> Callable[..., str]:
    def rule(values: list[Value]) -> str:
        found = _one(values, dimension)
        return "" if found is not None and fits(found) else wanted

    return rule


def _stroke(values: list[Value]) -> str:
    length = _one(values, units.LENGTH)
    word = values[0].value if len(values) == 1 and isinstance(values[0], TextVal) else None
    if length == 0 or word == NO_OUTLINE.value:
        values[:] = [NO_OUTLINE]
        return ""
    is_one = length is not None and THINNEST <= length <= WIDEST
    widths = f"a width of {THINNEST:g} to {WIDEST:g} mm, as in `@stroke(0.3mm)`"
    return "" if is_one else f"{widths}, or `none` for a solid without outline"


def _dash(values: list[Value]) -> str:
    lengths = _numbers(values, units.LENGTH)
    if not values or [type(v) for v in values] == [bool]:
        return ""
    if lengths is None or not all(THINNEST <= length <= WIDEST for length in lengths):
        return f"lengths of {THINNEST:g} to {WIDEST:g} mm, of a dash and of a gap, as in `@dash(3, 1.5)`"
    is_paired = len(lengths) == 1 or len(lengths) % 2 == 0
    return "" if is_paired else "a gap for each dash, as in `@dash(6, 1.5, 1, 1.5)`"


def _shade(values: list[Value]) -> str:
    kind, angles = values[:1], _numbers(values[1:], units.ANGLE)
    is_color = len(kind) == 1 and isinstance(kind[0], TextVal) and css_color([kind[0].value]) is not None
    if (is_color or _is_one_of(kind, SHADES)) and angles is not None and len(angles) <= 1:
        values[:1] = kind
        return ""
    words = ", ".join(ticked(SHADES))
    return f"{words}, or a colour, and where wanted the way it goes, as in `@shade(round, 90deg)`"


def _shadow(values: list[Value]) -> str:
    by, dark = _numbers(values[:2], units.LENGTH), _numbers(values[2:], units.PLAIN)
    is_dark = dark is not None and len(dark) <= 1 and all(0 < share <= 1 for share in dark)
    if by is not None and len(by) == 2 and max(map(abs, by)) <= WIDEST and is_dark:
        return ""
    return "two lengths, to the right and up, and where wanted a share of black, as in `@shadow(3, -3, 0.3)`"


def _text(name: str) -> Callable[[list[Value]], str]:
    def rule(values: list[Value]) -> str:
        is_text = len(values) == 1 and isinstance(values[0], TextVal)
        return "" if is_text else f'a text, as in `@{name}("…")`'

    return rule


def _yes_or_no(values: list[Value]) -> str:
    return "" if not values or [type(v) for v in values] == [bool] else "nothing, or true or false"


def _numbers(values: list[Value], dimension: units.Dimension) -> list[float] | None:
    """Returns numbers of a dimension, or without one; None if there is anything else among the values."""
    found = [v.value for v in values if isinstance(v, Num) and v.dimension in (None, dimension)]
    return found if len(found) == len(values) else None


def _one(values: list[Value], dimension: units.Dimension) -> float | None:
    found = _numbers(values, dimension)
    return found[0] if found is not None and len(found) == 1 else None


_WANTED: Mapping[str, Callable[[list[Value]], str]] = {
    "orientation": _worded(ORIENTATIONS, "one of `top`, `front` and `side`, as in `@orientation(front)`"),
    "thickness": _one_number(units.LENGTH, lambda n: n > 0, "a length above 0, as in `@thickness(3mm)`"),
    "depth": _depth,
    "elevation": _one_number(
        units.LENGTH, lambda _: True, "a length, as in `@elevation(18mm)` or `@elevation(-3)`"
    ),
    "quantity": _one_number(
        units.PLAIN,
        lambda n: n == int(n) and 1 <= n <= MOST,
        f"a whole number of pieces from 1 to {MOST}, as in `@quantity(4)`",
    ),
    **{name: _text(name) for name in ("layer", "material", "note", "title", "author", "number", "revision")},
    **{name: _text(name) for name in ("thread", "tolerance", "finish")},
    "detached": _yes_or_no,
    "rigid": _yes_or_no,
    "stroke": _stroke,
    "dash": _dash,
    "opacity": _one_number(
        units.PLAIN, lambda n: 0 < n <= 1, "a share above 0, and up to 1, as in `@opacity(0.5)`"
    ),
    "shade": _shade,
    "shadow": _shadow,
    "edges": _worded(EDGES, "`seams` or `outline`, as in `@edges(seams)`"),
    "halo": _one_number(
        units.LENGTH, lambda n: 0 <= n <= WIDEST, f"a width of 0 to {WIDEST:g} mm, as in `@halo(1)`"
    ),
}
"""What is said of an attribute whose arguments do not fit; "" if they do."""
