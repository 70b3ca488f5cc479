"""Random trees of parts with a known true picture: constraints hold there, and guesses are off."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TypeAlias

Pair: TypeAlias = tuple[float, float]

OFF = 0.2
"""How far guesses are off at most, as a part of the size of the picture."""
SIDES = (("left", "center_x", "right"), ("bottom", "center_y", "top"))


@dataclass
class Part:
    """A geometry, or a structure with members. Places are those of the true picture, in the root's frame."""

    name: str
    shape: str
    size: Pair
    center: Pair = (0.0, 0.0)
    frame: Pair = (0.0, 0.0)
    members: list[Part] = field(default_factory=list)
    constraints: list[str] = field(default_factory=list)
    is_fixed: bool = False
    is_tied: bool = False
    """Whether its size is a guess that constraints decide."""
    is_exact: bool = False
    """Whether the places in it are fixed in its frame, so that it needs no constraints."""

    def side(self, axis: int, which: int) -> float:
        """The lower side, the middle or the upper side of the box along an axis, by -1, 0 or 1."""
        return self.center[axis] + which * self.size[axis] / 2

    def move(self, by: Pair) -> None:
        self.center = plus(self.center, by)
        self.frame = plus(self.frame, by)
        for member in self.members:
            member.move(by)

    def enclose(self) -> None:
        """Takes the box around the members."""
        low = [min(m.side(axis, -1) for m in self.members) for axis in (0, 1)]
        high = [max(m.side(axis, 1) for m in self.members) for axis in (0, 1)]
        self.center = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2)
        self.size = (high[0] - low[0], high[1] - low[1])

    def leaves(self, path: str) -> Iterator[tuple[str, Part]]:
        for m in self.members:
            if m.members:
                yield from m.leaves(f"{path}.{m.name}")
            else:
                yield f"{path}.{m.name}", m

    @property
    def depth(self) -> int:
        return 1 + max((m.depth for m in self.members), default=0)


@dataclass(frozen=True)
class Picture:
    """A program, what is true of it, and the same said in other orders."""

    root: Part
    noise: dict[int, Pair]
    """How far the guess of a part is off, by its identity."""

    @property
    def truth(self) -> dict[str, tuple[float, ...]]:
        """Centre and size of each geometry by its path."""
        return {path: (*m.center, *m.size) for path, m in self.root.leaves("d")}

    @property
    def unnamed(self) -> list[str]:
        """The paths of what no constraint names, neither it nor anything in it: nobody says where it is."""
        return list(self._unnamed(self.root, "d", ""))

    def _unnamed(self, part: Part, path: str, said: str) -> Iterator[str]:
        said = "\n".join([said, *part.constraints])
        for m in part.members:
            names = "|".join([m.name, *(below.rpartition(".")[2] for below, _ in m.leaves(""))])
            if not m.is_fixed and not re.search(rf"\b({names})\b", said):
                yield f"{path}.{m.name}"
            yield from self._unnamed(m, f"{path}.{m.name}", said)

    @property
    def exact(self) -> Picture:
        """The same with every guess right."""
        return replace(self, noise=dict.fromkeys(self.noise, (0.0, 0.0)))

    def text(self, chance: random.Random | None = None) -> str:
        """The program; with `chance`, members and constraints in another order."""
        return "\n".join(self._lines(self.root, (0.0, 0.0), chance)) + "\n"

    def _lines(self, part: Part, frame: Pair, chance: random.Random | None) -> Iterator[str]:
        local = minus(part.center, frame)
        if not part.members:
            size = plus(part.size, self.noise[id(part)]) if part.is_tied else part.size
            yield f"{part.name} = {drawn(part, self._place(part, local), size)}"
            return
        at = minus(part.frame, frame)
        place = f" at {self._place(part, at)}" if part.name != "d" else ""
        yield f"drawing {part.name}{place} {{"
        members, constraints = list(part.members), list(part.constraints)
        if chance is not None:
            chance.shuffle(members)
            chance.shuffle(constraints)
        for member in members:
            yield from (f"    {line}" for line in self._lines(member, part.frame, chance))
        if constraints:
            yield "    constrain {"
            yield from (f"        {text}" for text in constraints)
            yield "    }"
        yield "}"

    def _place(self, part: Part, true: Pair) -> str:
        if part.is_fixed:
            return f"fixed({written(true)})"
        return written(plus(true, self.noise[id(part)]))


def plus(a: Pair, b: Pair) -> Pair:
    return a[0] + b[0], a[1] + b[1]


def minus(a: Pair, b: Pair) -> Pair:
    return a[0] - b[0], a[1] - b[1]


def written(p: Pair) -> str:
    return f"({p[0]:g}, {p[1]:g})"


def drawn(part: Part, center: str, size: Pair) -> str:
    width, height = size
    match part.shape:
        case "rectangle" if part.is_tied:
            width, height = max(width, 1.0), max(height, 1.0)
            return f"rectangle(center: {center}, width: guess({width:g}), height: guess({height:g}))"
        case "rectangle":
            return f"rectangle(center: {center}, width: {width:g}, height: {height:g})"
        case "slot":
            return f"slot(center: {center}, length: {width:g}, width: {height:g})"
        case _:
            return f"circle(center: {center}, radius: {width / 2:g})"


def picture(chance: random.Random) -> Picture:
    """A true picture, constraints that hold there and mostly determine it, an anchor, and guesses."""
    root = _structure("d", chance, depth=chance.randint(1, 3))
    root.move(minus((0.0, 0.0), root.frame))
    _anchor(root, chance)
    _constrain(root, chance)
    return Picture(root, _noise(root, chance))


def _noise(root: Part, chance: random.Random) -> dict[int, Pair]:
    most = OFF * max(root.size) / (root.depth - 1)
    found: dict[int, Pair] = {}
    stack = list(root.members)
    while stack:
        part = stack.pop()
        found[id(part)] = (round(chance.uniform(-most, most), 1), round(chance.uniform(-most, most), 1))
        stack += part.members
    return found


# --- The true picture --------------------------------------------------------------------------------


def _leaf(name: str, chance: random.Random) -> Part:
    shape = chance.choice(("rectangle", "rectangle", "circle", "slot"))
    width, height = (2.0 * chance.randint(2, 12) for _ in range(2))
    if shape == "circle":
        height = width
    if shape == "slot":
        width += height
    return Part(name, shape, (width, height))


def _structure(name: str, chance: random.Random, depth: int) -> Part:
    """A structure with its members laid out, at a frame of its own."""
    count = chance.randint(2, 4)
    names = [f"{name}{letter}" if name != "d" else letter for letter in "pqrs"[:count]]
    members = [
        _structure(n, chance, depth - 1) if depth > 1 and chance.random() < 0.6 else _leaf(n, chance)
        for n in names
    ]
    part = Part(name, "structure", (0.0, 0.0), members=members)
    part.is_exact = name != "d" and depth == 1 and chance.random() < 0.25
    ARRANGEMENTS[chance.choice(list(ARRANGEMENTS))](part, chance)
    part.enclose()
    if chance.random() < 0.5 and not any(text.startswith("symmetric") for text in part.constraints):
        shift = (float(chance.randint(-30, 30)), float(chance.randint(-30, 30)))
        for member in members:
            member.move(shift)
        part.enclose()
    return part


def _put(part: Part, center: Pair) -> None:
    part.move(minus(center, part.center))


def _in_line(part: Part, chance: random.Random, axis: int, aligned: bool) -> float:
    """Puts the members one after another with one gap, which is returned; y runs downwards."""
    gap, sense = float(chance.randint(0, 12)), (1, -1)[axis]
    along = 0.0
    across = float(chance.randint(-10, 10))
    for member in part.members:
        along += sense * member.size[axis] / 2
        other = across if aligned else float(chance.randint(-15, 15))
        _put(member, (along, other) if axis == 0 else (other, along))
        along += sense * (member.size[axis] / 2 + gap)
    return gap


def _names(part: Part) -> str:
    return ", ".join(m.name for m in part.members)


def _row(part: Part, chance: random.Random) -> None:
    axis = chance.randint(0, 1)
    word, align = (("row", "center"), ("column", "center"))[axis]
    gap = _in_line(part, chance, axis, aligned=True)
    part.constraints.append(f"{word}({_names(part)}, gap: {gap:g}, align: {align})")


def _loose_row(part: Part, chance: random.Random) -> None:
    axis = chance.randint(0, 1)
    gap = _in_line(part, chance, axis, aligned=False)
    part.constraints.append(f"{('row', 'column')[axis]}({_names(part)}, gap: {gap:g})")
    for a, b in pairwise(part.members):
        part.constraints.append(_relation(b, a, 1 - axis, chance))


def _even(part: Part, chance: random.Random) -> None:
    _in_line(part, chance, 0, aligned=False)
    first, *middle, last = part.members
    part.constraints.append(_relation(last, first, 0, chance))
    if middle:
        part.constraints.append(f"evenly_spaced({_names(part)}, axis: x)")
    for a, b in pairwise(part.members):
        part.constraints.append(_relation(b, a, 1, chance))


def _free(part: Part, chance: random.Random) -> None:
    for i, member in enumerate(part.members):
        _put(member, (float(chance.randint(-60, 60)), float(chance.randint(-60, 60))))
        if i:
            for axis in (0, 1):
                part.constraints.append(_relation(member, chance.choice(part.members[:i]), axis, chance))


def _spread(part: Part, chance: random.Random) -> None:
    """The first holds the others, which are spread in it, and one more stands amid two of these."""
    hull, *others = part.members
    if len(others) < 2 or hull.members:
        _free(part, chance)
        return
    margin, gap = (float(chance.randint(0, 9)) for _ in range(2))
    along = margin
    for member in others:
        _put(member, (along + member.size[0] / 2, float(chance.randint(-20, 20))))
        along += member.size[0] + gap
    hull.shape = "rectangle"
    hull.size = (along - gap + margin, hull.size[1])
    _put(hull, (hull.size[0] / 2, 0.0))
    names = ", ".join(m.name for m in others)
    part.constraints.append(f"spread({names}, inside: {hull.name}, axis: x, margin: {margin:g})")
    for member in others:
        part.constraints.append(_relation(member, hull, 1, chance))


def _tied(part: Part, chance: random.Random) -> None:
    """Rectangles whose sizes are those of the first, and one with its sides at others'."""
    first, second, *others = part.members
    if first.members or second.members:
        _free(part, chance)
        return
    first.shape = second.shape = "rectangle"
    first.size = (2.0 * chance.randint(2, 12), 2.0 * chance.randint(2, 12))
    second.size, second.is_tied = first.size, True
    part.constraints.append(f"{chance.choice(('same_size', 'equal'))}({second.name}, {first.name})")
    _free(part, chance)
    if others and not others[-1].members:
        last = others[-1]
        x, y = first.side(0, -1), first.side(1, 1)
        width, height = max(2.0, second.side(0, 1) - x), 2.0 * chance.randint(2, 9)
        part.constraints = [text for text in part.constraints if not re.search(rf"\b{last.name}\b", text)]
        if second.side(0, 1) - x < 2.0:
            x, width = second.side(0, -1), max(2.0, first.side(0, 1) - second.side(0, -1))
            ends = (second.name, first.name)
        else:
            ends = (first.name, second.name)
        last.shape, last.size, last.is_tied = "rectangle", (width, height), True
        _put(last, (x + width / 2, y + height / 2))
        part.constraints += [
            f"{last.name}.bb.left == {ends[0]}.bb.left",
            f"{last.name}.bb.right == {ends[1]}.bb.right",
            f"{last.name}.above({first.name}, gap: 0)",
            f"{last.name}.bb.height == {height:g}",
        ]


def _distant(part: Part, chance: random.Random) -> None:
    """Each at a distance from the one before, far enough that the guesses tell on which side."""
    for i, member in enumerate(part.members):
        if not i:
            _put(member, (0.0, 0.0))
            continue
        before = part.members[i - 1]
        by = chance.choice(((150.0, 0.0), (120.0, 90.0), (160.0, -120.0), (144.0, 60.0)))
        _put(member, plus(before.center, by))
        if before.shape == member.shape == "circle":
            part.constraints.append(f"distance({member.name}, {before.name}) == {math.hypot(*by):g}")
        else:
            part.constraints.append(f"{before.name}.bb.center.x == {member.name}.bb.center.x - {by[0]:g}")
        part.constraints.append(_relation(member, before, 1, chance))


def _around(part: Part, chance: random.Random) -> None:
    """The first in the middle, the others in it or about it."""
    first, *others = part.members
    _put(first, (0.0, 0.0))
    for member in others:
        if chance.random() < 0.5:
            _put(member, (0.0, 0.0))
            part.constraints.append(
                f"{member.name}.{chance.choice(('centered_in', 'concentric'))}({first.name})"
            )
        else:
            _put(member, (float(chance.randint(-40, 40)), first.side(1, 1) + member.size[1] / 2))
            part.constraints.append(f"{member.name}.above({first.name}, gap: 0)")
            part.constraints.append(_relation(member, first, 0, chance))


def _mirrored(part: Part, chance: random.Random) -> None:
    """Two of a kind about the y axis of the frame, the others anywhere."""
    first, second, *others = part.members
    if first.members or second.members:
        _free(part, chance)
        return
    second.shape, second.size = first.shape, first.size
    x, y = first.size[0] / 2 + chance.randint(1, 40), float(chance.randint(-30, 30))
    _put(first, (-x, y))
    _put(second, (x, y))
    part.constraints.append(f"symmetric({first.name}, {second.name}, axis: y)")
    part.constraints.append(_relation(second, first, 0, chance))
    known = [first, second]
    for member in others:
        _put(member, (float(chance.randint(-60, 60)), float(chance.randint(-60, 60))))
        for axis in (0, 1):
            part.constraints.append(_relation(member, chance.choice(known), axis, chance))
        known.append(member)


ARRANGEMENTS: dict[str, Callable[[Part, random.Random], None]] = {
    "row": _row,
    "loose row": _loose_row,
    "even": _even,
    "free": _free,
    "around": _around,
    "mirrored": _mirrored,
    "spread": _spread,
    "tied": _tied,
    "distant": _distant,
}


# --- Constraints -------------------------------------------------------------------------------------


def _reached(part: Part, chance: random.Random) -> tuple[str, Part]:
    """The part, or something in it, by its path."""
    path = part.name
    while part.members and chance.random() < 0.35:
        part = chance.choice(part.members)
        path += f".{part.name}"
    return path, part


def _relation(a: Part, b: Part, axis: int, chance: random.Random) -> str:
    """A constraint that says where `a` is along an axis if that is known of `b`, or the other way round."""
    (p, a), (q, b) = _reached(a, chance), _reached(b, chance)
    if chance.random() < 0.25:
        p, a, q, b = q, b, p, a
    choices = []
    for i in (-1, 0, 1):
        j = chance.choice((-1, 0, 1))
        by = a.side(axis, i) - b.side(axis, j)
        left, right = f"{p}.bb.{SIDES[axis][i + 1]}", f"{q}.bb.{SIDES[axis][j + 1]}"
        choices.append(
            f"{left} == {right} {'-' if by < 0 else '+'} {abs(by):g}" if by else f"{left} == {right}"
        )
        by = a.side(axis, i) - b.side(axis, i)
        if by == 0:
            word = (
                "align_left",
                "align_center_x",
                "align_right",
                "align_bottom",
                "align_center_y",
                "align_top",
            )
            choices += [f"{word[3 * axis + i + 1]}({p}, {q})"] * 2
    by = a.center[axis] - b.center[axis]
    choices.append(f"{('centered_horizontally', 'centered_vertically')[axis]}({p}, {q}, by: {by:g})")
    for (one, x), (other, y) in (((p, a), (q, b)), ((q, b), (p, a))):
        gap = x.side(axis, -1) - y.side(axis, 1)
        if gap >= 0:
            choices += [f"{one}.{('right_of', 'above')[axis]}({other}, gap: {gap:g})"] * 2
            choices += [f"{other}.{('left_of', 'below')[axis]}({one}, gap: {gap:g})"] * 2
    return chance.choice(choices)


def _anchor(root: Part, chance: random.Random) -> None:
    """Holds one geometry, and the frames that it is in."""
    part = root
    while part.members:
        part = chance.choice(part.members)
        part.is_fixed = True


def _constrain(part: Part, chance: random.Random) -> None:
    """Adds what follows already, leaves something out now and then, and holds what is exact."""
    for member in part.members:
        if member.members:
            _constrain(member, chance)
    if part.is_exact:
        part.constraints.clear()
        for member in part.members:
            member.is_fixed, member.is_tied = True, False
        return
    if chance.random() < 0.15:
        part.constraints.remove(chance.choice(part.constraints))
    for _ in range(chance.randint(0, 2)):
        a, b = chance.sample(part.members, 2)
        part.constraints.append(chance.choice(list(_facts(a, b))))
    chance.shuffle(part.constraints)


def _facts(a: Part, b: Part) -> Iterator[str]:
    """Inequalities between two members that hold in the true picture."""
    p, q = a.name, b.name
    for axis in (0, 1):
        by = a.side(axis, 1) - b.side(axis, 1)
        yield f"{p}.bb.{SIDES[axis][2]} <= {q}.bb.{SIDES[axis][2]} {'-' if by < 0 else '+'} {abs(by):g}"
        word = ("width", "height")[axis]
        if a.size[axis] >= b.size[axis]:
            yield f"{p}.bb.{word} >= {q}.bb.{word}"
            yield f"{('wider', 'taller')[axis]}({p}, {q})"
        if a.side(axis, -1) >= b.side(axis, 1):
            yield f"{p}.{('right_of', 'above')[axis]}({q})"
        if not a.members:
            yield f"{p}.bb.{word} == {a.size[axis]:g}"
    if all(a.side(x, -1) >= b.side(x, -1) and a.side(x, 1) <= b.side(x, 1) for x in (0, 1)):
        yield f"{p}.inside({q})"
