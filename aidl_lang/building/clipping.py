"""What structures are clipped to, outlines or material: `@clip`, read when all geometry is there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import Nothing, TextVal, Value, each_of, kind_of
from aidl_lang.checking.builtins import CLIP
from aidl_lang.common.records import record
from aidl_lang.syntax import ast


@record()
class StatedClip:
    """A `@clip`, and the scope in which it is read."""

    attribute: ast.Attribute
    scope: Scope


def state_clip(it: Interpreter, s: Structure, stated: StatedClip) -> None:
    """Keeps what a structure is clipped to until all geometry is there. Of two, the later counts."""
    it.clips[s] = stated
    s.attributes[CLIP] = tuple(TextVal(a.value.span.one_line) for a in stated.attribute.arguments)


def settle_clips_in(it: Interpreter, parent: Structure) -> None:
    """Clips the structures in one whose body has been run to outlines of its own, or to itself: boxes leave
    out what is cut off.
    """
    for s in parent.children:
        if (stated := it.clips.get(s)) is not None and _names_own(stated, parent):
            _settle(it, s, stated)


def _names_own(stated: StatedClip, parent: Structure) -> bool:
    """Tells whether a clip names geometry that stands in a structure itself, or the structure."""
    values = [argument.value for argument in stated.attribute.arguments]
    if len(values) != 1 or not isinstance(name := values[0], ast.Name):
        return False
    scope = next((scope for scope in stated.scope.chain() if name.text in scope.values), None)
    named = None if scope is None else scope.values[name.text]
    is_outline = scope is not None and scope.container is parent and isinstance(named, Geometry)
    return is_outline or named is parent


def settle_clips(it: Interpreter) -> None:
    """Gives structures what they are clipped to, if they have not; copies get theirs with the copies."""
    for s, stated in it.clips.items():
        if not s.clip and s.ground is None:
            _settle(it, s, stated)


def _settle(it: Interpreter, s: Structure, stated: StatedClip) -> None:
    env = Env(stated.scope, s.parent or s, Reach.READ)
    values = [evaluate(it, argument.value, env) for argument in stated.attribute.arguments]
    if any(isinstance(value, Nothing) for value in values):
        return
    match values:
        case [Structure(kind="solid") as solid] if s.kind == "drawing":
            s.ground = solid
        case _:
            s.clip = tuple(_outline(it, s, stated, values))


def _outline(
    it: Interpreter, s: Structure, stated: StatedClip, values: Sequence[Value]
) -> Iterator[Geometry]:
    attribute = stated.attribute
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
