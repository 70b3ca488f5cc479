"""Programs of random calls: everything that can be called, with arguments of right and of wrong kinds, as
geometry, constraint, assertion, statement and value.
"""

from __future__ import annotations

import random
from collections.abc import Sequence

from aidl_lang.checking import builtins, library
from aidl_lang.checking.types import Signature

CALLABLES = {**builtins.SIGNATURES}
for _name, _overloads in library.load().callables.items():
    CALLABLES[_name] = (*CALLABLES.get(_name, ()), *_overloads)

SETTING = """\
param p = 5 in 1..1000
param word = "m3" in ["m3", "m4"]
fn twice(z) = z + z
shape plus(size: length) {{ body = square(size: size) }}
assembly top {{
    var v = 3
    pt = (1, 2)
    l = line((0, 0), (20, 0))
    k = line((0, 0), (20, 10))
    a = arc(center: (40, 0), radius: 10, start_angle: 0deg, end_angle: 90deg)
    c = circle(center: (30, 30), radius: 5)
    r = rectangle(center: (-30, 30), width: 20, height: 10)
    e = ellipse(center: (0, 50), rx: 9, ry: 4)
    b = bezier((0, 0), (5, 5), (10, 5), (15, 0))
    q = path(from: (50, 0), line_to(60, 0), line_to(60, 9), close())
    t = text("ab", height: 5)
    for i in 0..2 {{ m[i] = circle(center: (9 * i, -30), radius: 2) }}
    let n0 = [1, 2, 3]
    let rec = record(a: 1, size: "m3", place: (1, 2))
    solid s at (80, 0) {{ body = rectangle(width: 10, height: 10) }}
    solid s2 at (99, 0) {{ body = circle(radius: 5) }}
{body}
}}
"""

SMALL = ("1", "2", "7", "10", "2.5", "5mm", "30deg", "90deg", "360", "-3", "0")
ODD = (
    "1e300",
    "-1e300",
    "1e-300",
    "1e9",
    "1e6",
    "-0.0",
    "0.1 + 0.2",
    "1e999",
    "0/0",
    "1/0",
    "sqrt(-1)",
    "3..1",
)
UNKNOWN = (
    "v",
    "c.radius",
    "l.length",
    "p",
    "guess(4)",
    "fixed(4)",
    "s.width",
    "v / (v - v)",
    "sqrt(v - 99)",
    "-v",
)
POINTS = (
    *("(0, 0)", "(0, 0)", "(10, 0)", "(3, 8)", "[4, 5]", "origin", "pt", "l.start", "c.center", "s.center"),
    *("(1e300, 0)", "(v, 0)", "(1/0, 1)", "fixed((1, 2))", "guess((3, 4))", "polar(5, 72)", "(l.end.x, 3)"),
)
TEXTS = (
    *('"m3"', '"left"', '""', '"AB"', '"x"', '"medium"', '"round"', '"608"', '"nema17"', "word", "str(v)"),
    *(
        '"\\u200f\\u0627"',
        '"日本 ß é"',
        '"a\\nb\\n\\nc"',
        '"' + "long " * 60 + '"',
        "sharp",
        "left",
        "str([1, [2]])",
    ),
)
TRUTHS = ("true", "false", "v > 2", "p > 2", "c.radius == 5", "not (v > 2)", "overlaps(s, s2)", "1 == 1")
GEOMETRY = (
    "l",
    "k",
    "a",
    "c",
    "r",
    "e",
    "b",
    "q",
    "t",
    "m",
    "m[0]",
    "pt",
    "q.segment[0]",
    "r.left",
    "r.top",
    "x_axis",
)
STRUCTURES = ("s", "s2", "self", "top", "s.body", "s.bb")
LISTS = (
    *(
        "[]",
        "[1]",
        "n0",
        "[1, 2, 3, 4]",
        "[[1, 2], [3, 4], [5, 0]]",
        "[[[]]]",
        "m",
        '["a", "b"]',
        "[true, v]",
        "range(0)",
    ),
    *(
        "[(0, 0), (10, 0), (0, 10)]",
        "[(0, 0), (0, 0), (0, 0)]",
        "[(0, 0), (5, 0), (10, 0)]",
        "[(0, 0)]",
        "[s, s2]",
    ),
    *(
        "[l, a]",
        "[c, r]",
        "[i * v for i in 0..3]",
        "range(5)",
        "zip(n0, n0)",
        "[rec, rec]",
        "enumerate(m)",
        "0..4",
    ),
    *("[(0, 0), (10, 10), (10, 0), (0, 10)]", "[line_to(3, 4), close()]", "[p, (v, v), nothing]"),
)
RECORDS = (
    "rec",
    "record()",
    "record(a: v)",
    'record(size: "m3", size: 3)',
    'screw("m3")',
    'nema("nema17")',
    "rec.place",
)
GROUPS: Sequence[Sequence[str]] = (
    *(SMALL, ODD, UNKNOWN, POINTS, TEXTS, TRUTHS, GEOMETRY, STRUCTURES, LISTS, RECORDS),
)
FITTING: dict[str, Sequence[str]] = {
    "length": (*SMALL, *SMALL, *UNKNOWN, *ODD),
    "angle": (*SMALL, *SMALL, *UNKNOWN, *ODD),
    "plain number": (*SMALL, *UNKNOWN, *ODD),
    "whole number": ("0", "-1", "1", "2", "3", "5", "2.5", "1e9", "p", "v"),
    "text": TEXTS,
    "condition": TRUTHS,
    "point": POINTS,
    "list of points": LISTS,
    "list": LISTS,
    "record": RECORDS,
    "line": ("l", "k", "r.top", "q.segment[0]", "x_axis", "line((0, 0), (0, 0))"),
    "arc": ("a", "arc(center: (0, 0), start: (1, 0), end: (1, 0))"),
    "circle": ("c", "m[1]", "s2.body", "circle(radius: 0)"),
    "ellipse": ("e", "ellipse(rx: 0, ry: 3)"),
    "bezier": ("b",),
    "box": (*GEOMETRY, *STRUCTURES, "m", "[s, s2]", "[]"),
    "structure": STRUCTURES,
    "geometry": GEOMETRY,
}
WORDS = (
    "name",
    "radius",
    "width",
    "n",
    "center",
    "at",
    "x",
    "y",
    "size",
    "about",
    "gap",
    "angle",
    "of",
    "from",
)
OUTLINES = (
    "offset({}, 2)",
    "hull({}, c)",
    "mirror({}, about: y_axis)",
    "shell({}, 1)",
    "copy({}, by: (5, 5))",
    "{}.bb",
)
MAKING = (
    "x = {call}",
    "x = {call} w = {outline}",
    "x = {call} constrain x == {value}",
    "x = {call} constrain {{ x.radius == 3 x.width <= {value} tangent(x, l) }}",
    "x = {call} fillet(x, {number}) y = {outline}",
    "construction x = {call} constrain {{ x.above(c) }}",
    "solid u {{ x = {call} hole h {{ x = {call} }} }}",
    "solid u {{ x = {call} hole h at {point} {{ y = {outline} }} }}",
    "x = {call} at {point} rotated {number}",
    "for i in 0..2 {{ x[i] = {call} }}",
    "x = linear_array({call}, n: 3, pitch: {number})",
)
STATING = (
    "constrain {call}",
    "constrain {{ {call} {call2} }}",
    "prefer {call} weight {number}",
    "assert {call}",
    "{call}",
    "for i in 0..2 {{ constrain {call} }}",
)
COUNTING = (
    "x = circle(radius: {call})",
    "constrain {call} == {value}",
    "constrain c.radius <= {call}",
    'let y = {call} assert y > {number}, "y"',
    "hole h[{call}] {{ x = circle(radius: 3) }}",
    "if {call} {{ x = c }}",
    "x = polygon({call})",
    "x = [circle(radius: 3) for z in {call}]",
    "@note(str({call})) solid u {{ x = text(str({call}), height: 3) }}",
)
PLACES = {"ShapeDefinition": MAKING, "Structure": MAKING, "ConstraintDefinition": STATING}
ALL_PLACES = (*MAKING, *STATING, *COUNTING)


class Writer:
    """Writes programs; everything follows from the seed. `wild` is how often it does what does not fit."""

    def __init__(self, seed: object) -> None:
        self.random = random.Random(repr(seed))
        self.wild = self.random.choice((0.0, 0.02, 0.25))

    def program(self, name: str, signature: Signature) -> str:
        fitting = PLACES.get(type(signature.node).__name__, ALL_PLACES)
        place = self.random.choice(ALL_PLACES if self.random.random() < self.wild else fitting)
        body = place.format(
            call=self.call(name, signature, 0),
            call2=self.call(name, signature, 0),
            value=self.anything(1),
            number=self.fitting("length", 1),
            point=self.fitting("point", 1),
            outline=self.random.choice(OUTLINES).format("x"),
        )
        return SETTING.format(body="    " + body)

    def call(self, name: str, signature: Signature, depth: int) -> str:
        """A call, some of its arguments by name."""
        chance, arguments, named = self.random.random, [], False
        for word, kind, optional in signature.parameters:
            if chance() < (0.6 if optional else self.wild / 4):
                named = True
                continue
            value = self.anything(depth + 1) if chance() < self.wild else self.fitting(str(kind), depth)
            named = named or chance() < 0.4
            arguments.append(f"{word}: {value}" if named else value)
        if chance() < self.wild / 2:
            arguments.append(f"{self.random.choice(WORDS)}: {self.anything(depth + 1)}")
        on = f"{self.random.choice(GEOMETRY)}." if chance() < self.wild / 4 else ""
        return f"{on}{name}({', '.join(arguments)})"

    def fitting(self, kind: str, depth: int) -> str:
        choices = FITTING.get(kind)
        if choices is None:
            return self.anything(depth + 1)
        usual = len(choices) if self.random.random() < 0.2 + 2 * self.wild else 8
        return self.random.choice(choices[:usual])

    def anything(self, depth: int) -> str:
        if depth < 3 and self.random.random() < 0.2:
            name = self.random.choice(list(CALLABLES))
            return self.call(name, self.random.choice(CALLABLES[name]), depth + 1)
        return self.random.choice(self.random.choice(GROUPS))
