"""Programs of random calls: everything that can be called, with arguments of right and of wrong kinds, as
geometry, constraint, assertion, statement and value.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

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


def _groups() -> dict[str, tuple[str, ...]]:
    """What `calls.txt` has under each of its headings."""
    text = Path(__file__).with_name("calls.txt").read_text("utf-8")
    found = (part.partition("\n") for part in text.split("=== ")[1:])
    return {name: tuple(" | ".join(rows.splitlines()).split(" | ")) for name, _, rows in found}


KNOWN = _groups()
VALUES = list(KNOWN.values())[:10]  # up to records: what can be an argument
NUMBERS = (*KNOWN["small"], *KNOWN["unknown"], *KNOWN["odd"])
FITTING: dict[str, Sequence[str]] = {
    "length": (*KNOWN["small"], *NUMBERS),
    "angle": (*KNOWN["small"], *NUMBERS),
    "plain number": NUMBERS,
    "text": KNOWN["texts"],
    "condition": KNOWN["truths"],
    "point": KNOWN["points"],
    "list of points": KNOWN["lists"],
    "list": KNOWN["lists"],
    "record": KNOWN["records"],
    "box": (*KNOWN["geometry"], *KNOWN["structures"], "m", "[s, s2]", "[]"),
    "structure": KNOWN["structures"],
    **{
        kind: KNOWN[kind]
        for kind in ("whole number", "line", "arc", "circle", "ellipse", "bezier", "geometry")
    },
}
PLACES = dict.fromkeys(("ShapeDefinition", "Structure"), KNOWN["making"])
PLACES["ConstraintDefinition"] = KNOWN["stating"]
ALL_PLACES = (*KNOWN["making"], *KNOWN["stating"], *KNOWN["counting"])


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
            outline=self.random.choice(KNOWN["outlines"]).format("x"),
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
            arguments.append(f"{self.random.choice(KNOWN['words'])}: {self.anything(depth + 1)}")
        on = f"{self.random.choice(KNOWN['geometry'])}." if chance() < self.wild / 4 else ""
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
        return self.random.choice(self.random.choice(VALUES))
