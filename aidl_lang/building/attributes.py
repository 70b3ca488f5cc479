"""Attributes of structures and of geometry: their names, and their arguments."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from aidl_lang.building.clipping import StatedClip, state_clip
from aidl_lang.building.coerce import constant
from aidl_lang.building.colors import color_of
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.scopes import Scope
from aidl_lang.building.stacking import StatedOrder, state_order
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import Nothing, Num, TextVal, Value, each_of, holds
from aidl_lang.checking import units
from aidl_lang.checking.builtins import ATTRIBUTES, CLIP, NAMING, STACKING, WORDED
from aidl_lang.common.colors import css_color
from aidl_lang.common.names import find
from aidl_lang.common.prose import ticked, with_article
from aidl_lang.syntax import ast

OWN_LOOKS = {
    "drawing": ("color", "stroke", "dash", "opacity", "shade"),
    "solid": ("color", "opacity", "shade"),
    "assembly": ("color", "opacity", "shade"),
}
"""Attributes that a geometry may have for itself, by the kind of its structure."""


def read_attributes(it: Interpreter, s: Structure, attributes: Iterable[ast.Attribute], scope: Scope) -> None:
    """Reads the attributes that the checker has accepted."""
    for name, values, attribute in _read(it, attributes, Env(scope, s.parent or s, Reach.OWN)):
        if name in STACKING:
            state_order(it, s, StatedOrder(name, attribute, scope))
        elif name == CLIP:
            state_clip(it, s, StatedClip(attribute, scope))
        elif _fits(it, name, values, attribute) and _shows(it, name, values, attribute, s):
            s.attributes[name] = tuple(values)


def read_own_attributes(
    it: Interpreter, node: ast.Assign, value: Value, container: Structure | Geometry, scope: Scope
) -> None:
    """Reads the attributes of a geometry; reports those for structures only."""
    things = list(each_of(value, Geometry))
    here = container if isinstance(container, Structure) else container.owner
    for name, values, attribute in _read(it, node.attributes, Env(scope, here, Reach.OWN)):
        is_own = here is container and name in OWN_LOOKS.get(here.kind, ())
        if not things or not (name == "note" or is_own):
            _misplaced(it, node, name, attribute, value, container)
        elif _fits(it, name, values, attribute) and _shows(it, name, values, attribute, here):
            for thing in things:
                thing.attributes = thing.attributes | {name: tuple(values)}


def _misplaced(
    it: Interpreter,
    node: ast.Assign,
    name: str,
    attribute: ast.Attribute,
    value: Value,
    container: Structure | Geometry,
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
"""What `@stroke` says of solids without outline; a width of 0 says the same."""
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


def _shows(it: Interpreter, name: str, values: list[Value], attribute: ast.Attribute, of: Structure) -> bool:
    """Tells whether a look is one of such a structure; a drawing is nothing but its strokes."""
    written, is_flat, wrong, hint = attribute.span.one_line, of.kind in ("drawing", "hole"), "", ""
    if (name == "edges" and is_flat) or (name == "halo" and of.kind == "hole"):
        has = "material or strokes" if name == "halo" else "material"
        wrong = f"is said of what has {has}, and `{of.name}` is a {of.kind}"
        hint = f"leave `{written}` out, or put it before a `solid` or an `assembly`"
    elif name == "quantity" and is_flat:
        wrong = f"is said of parts to be made, and `{of.name}` is a {of.kind}"
        hint = f"put `{written}` before a `solid` or an `assembly`"
    elif name == "depth" and of.kind != "hole":
        wrong = f"is said of holes, and `{of.name}` is {with_article(of.kind)}"
        hint = "make it a `hole`: what it encloses is taken away down to that depth"
    elif name == "stroke" and of.kind == "drawing" and values == [NO_OUTLINE]:
        wrong = "of a drawing takes a width: it is nothing but strokes"
        hint = f"give a width, as in `@stroke(0.3mm)`, or leave `{written}` out"
    if wrong:
        it.report("E0517", f"`@{attribute.name.text}` {wrong}", attribute, hints=[hint])
    return not wrong


def _worded(words: Sequence[str], wanted: str) -> Callable[[list[Value]], str]:
    return lambda values: "" if _is_one_of(values, words) else wanted


def _is_one_of(values: list[Value], words: Sequence[str]) -> bool:
    """Tells whether the one value is one of some words, and corrects its spelling."""
    word = values[0] if len(values) == 1 else None
    meant = find(word.value, dict.fromkeys(words)) if isinstance(word, TextVal) else None
    if meant is not None:
        values[:] = [TextVal(meant)]
    return meant is not None


def _thickness(values: list[Value]) -> str:
    if (length := _one(values, units.LENGTH)) is None:
        return "a length above 0, as in `@thickness(3mm)`"
    return "" if length > 0 else "a thickness above 0"


def _depth(values: list[Value]) -> str:
    length, taper = _numbers(values[:1], units.LENGTH), _numbers(values[1:], units.ANGLE)
    wanted = "a length above 0, and for a cone its angle, as in `@depth(2mm)` or `@depth(2mm, 90deg)`"
    if not length or taper is None or len(taper) > 1:
        return wanted
    return "" if length[0] > 0 and all(0 < angle < 180 for angle in taper) else wanted


def _elevation(values: list[Value]) -> str:
    is_one = _one(values, units.LENGTH) is not None
    return "" if is_one else "a length, as in `@elevation(18mm)` or `@elevation(-3)`"


def _quantity(values: list[Value]) -> str:
    count = _one(values, units.PLAIN)
    is_one = count is not None and count == int(count) and 1 <= count <= MOST
    return "" if is_one else f"a whole number of pieces from 1 to {MOST}, as in `@quantity(4)`"


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


def _halo(values: list[Value]) -> str:
    width = _one(values, units.LENGTH)
    is_one = width is not None and 0 <= width <= WIDEST
    return "" if is_one else f"a width of 0 to {WIDEST:g} mm, as in `@halo(1)`"


def _opacity(values: list[Value]) -> str:
    share = _one(values, units.PLAIN)
    is_one = share is not None and 0 < share <= 1
    return "" if is_one else "a share above 0, and up to 1, as in `@opacity(0.5)`"


def _shade(values: list[Value]) -> str:
    kind, angles = values[:1], _numbers(values[1:], units.ANGLE)
    is_color = len(kind) == 1 and isinstance(kind[0], TextVal) and css_color([kind[0].value]) is not None
    if (is_color or _is_one_of(kind, SHADES)) and angles is not None and len(angles) <= 1:
        values[:1] = kind
        return ""
    words = ", ".join(ticked(SHADES))
    return f"{words}, or a colour, and where wanted the way it goes, as in `@shade(round, 90deg)`"


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
    "thickness": _thickness,
    "depth": _depth,
    "elevation": _elevation,
    "quantity": _quantity,
    "layer": _text("layer"),
    "material": _text("material"),
    **{name: _text(name) for name in ("note", "title", "author", "number", "revision")},
    **{name: _text(name) for name in ("thread", "tolerance", "finish")},
    "detached": _yes_or_no,
    "rigid": _yes_or_no,
    "stroke": _stroke,
    "dash": _dash,
    "opacity": _opacity,
    "shade": _shade,
    "edges": _worded(EDGES, "`seams` or `outline`, as in `@edges(seams)`"),
    "halo": _halo,
}
"""What is said of an attribute whose arguments do not fit; "" if they do."""
