"""Where the fuzzer has its programs from: soups of tokens, programs of this project with something changed in
them, and programs made up that mean something. Each follows from a seed.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path

from aidl_lang.common.source import SourceFile
from aidl_lang.syntax.tables import tokenize
from aidl_lang.tools.reference.collect import reference
from tests.documents import ROOT, programs
from tests.fuzz.calls import CALLABLES, Writer
from tests.property.programs import COMPARISONS, RELATIONS

FOUND = Path(__file__).parent / "programs"
"""Programs that broke something once, as small as they could be made."""

_NUMBERS = """
0 1 -1 2 0.5 3.0 100 1000 12000 1e6 1e9 1e12 1e30 1e300 1e308 1e-9 1e-300 15000000.0 0.1 1/0 90deg 360deg
1e9deg 5mm 1e300mm -0.0
"""
"""Numbers that numbers are exchanged for."""
_EXTRA = ("/*", "*/", "//", "///", *"\\\"'/}{()[],;@é\0\n")


@cache
def seeds() -> tuple[str, ...]:
    """The programs of the project: examples, those in the library, docs and specs, and what was found."""
    files = sorted([*(ROOT / "examples").glob("*.aidl"), *FOUND.glob("*.aidl")])
    texts = [path.read_text("utf-8") for path in files]
    pages = sorted([*(ROOT / "docs").rglob("*.md"), *(ROOT / "tests" / "spec").glob("*.md")])
    texts += [block.text for page in pages for block in programs(page)]
    texts += [entry.doc.example for entry in reference().entries.values() if entry.doc.example]
    return tuple(dict.fromkeys(texts))


@cache
def _tokens(text: str) -> tuple[str, ...]:
    """The tokens of a text with the blanks and comments before each."""
    ends = [0, *(token.end for token in tokenize(SourceFile("seed", text)).tokens)]
    return tuple(text[a:b] for a, b in pairwise(ends) if b > a)


@cache
def _vocabulary() -> tuple[str, ...]:
    """Every token that stands in a seed, as often as it is the first of a new text."""
    return tuple(token.strip() for text in seeds() for token in dict.fromkeys(_tokens(text)))


def soup(chance: random.Random) -> str:
    """Tokens one behind the other."""
    glue = chance.choice(("", " ", " ", "\n"))
    words = _vocabulary()
    return glue.join(
        chance.choice(_EXTRA) if chance.random() < 0.1 else chance.choice(words)
        for _ in range(chance.randrange(1, 60))
    )


def mutant(chance: random.Random, texts: Sequence[str] = ()) -> str:
    """A seed, or one of other texts, with some of its tokens left out, doubled, exchanged or brought in."""
    text = chance.choice(texts or seeds())
    tokens = list(_tokens(text))
    for _ in range(chance.choice((1, 1, 1, 2, 3, 6, 12))):
        _CHANGES[chance.randrange(len(_CHANGES))](chance, tokens)
        if not tokens:
            break
    return "".join(tokens)


def misspelt(chance: random.Random, texts: Sequence[str] = ()) -> str:
    """A seed, or one of other texts, with slips in some of its names."""
    tokens = list(_tokens(chance.choice(texts or seeds())))
    places = [k for k, token in enumerate(tokens) if len(_NAME.findall(token.strip())) == 1]
    for at in chance.sample(places, min(len(places), chance.choice((1, 1, 2, 3, 6)))):
        tokens[at] = _NAME.sub(lambda found: slip(chance, found[0]), tokens[at])
    return "".join(tokens)


_NAME = re.compile(r"\b[A-Za-z_]\w*")


def slip(chance: random.Random, name: str) -> str:
    """A name with one letter left out, doubled, exchanged with its neighbour, or another one."""
    at = chance.randrange(len(name))
    before, here, after = name[:at], name[at], name[at + 1 :]
    return chance.choice(
        (
            before + after or here,
            before + here + here + after,
            before + after[:1] + here + after[1:],
            before + chance.choice("aeioustrnlm") + after,
        )
    )


def _leave_out(chance: random.Random, tokens: list[str]) -> None:
    at = chance.randrange(len(tokens))
    del tokens[at : at + chance.choice((1, 1, 2, 5, 20))]


def _repeat(chance: random.Random, tokens: list[str]) -> None:
    at = chance.randrange(len(tokens))
    tokens[at:at] = tokens[at : at + chance.choice((1, 2, 10, 40))]


def _exchange(chance: random.Random, tokens: list[str]) -> None:
    a, b = chance.randrange(len(tokens)), chance.randrange(len(tokens))
    tokens[a], tokens[b] = tokens[b], tokens[a]


def _bring_in(chance: random.Random, tokens: list[str]) -> None:
    other = _tokens(chance.choice(seeds()))
    if other:
        start = chance.randrange(len(other))
        at = chance.randrange(len(tokens))
        tokens[at:at] = other[start : start + chance.choice((1, 3, 10, 30))]


def _put_in(chance: random.Random, tokens: list[str]) -> None:
    tokens.insert(chance.randrange(len(tokens)), chance.choice(_EXTRA))


def _other_number(chance: random.Random, tokens: list[str]) -> None:
    places = [k for k, token in enumerate(tokens) if re.match(r"\s*[\d.]+", token)]
    if places:
        at = chance.choice(places)
        blank = tokens[at][: len(tokens[at]) - len(tokens[at].lstrip())]
        tokens[at] = blank + chance.choice(_NUMBERS.split())


def _cut_off(chance: random.Random, tokens: list[str]) -> None:
    del tokens[chance.randrange(len(tokens)) :]


_CHANGES: tuple[Callable[[random.Random, list[str]], None], ...] = (
    *(_leave_out, _leave_out, _repeat, _exchange, _bring_in, _put_in),
    *(_other_number, _other_number, _other_number, _cut_off),
)


def calls(chance: random.Random) -> str:
    """A program of random calls."""
    name = chance.choice(list(CALLABLES))
    return Writer(chance.random()).program(name, chance.choice(CALLABLES[name]))


def assembly(chance: random.Random) -> str:
    """Parts of random shapes, turned and nested, under relations that may or may not go together."""
    count = chance.randrange(2, 7)
    lines = ["assembly model {"]
    for k in range(count):
        turn = chance.choice(
            ("", "", f" rotated {chance.randrange(360)}deg", f" at ({chance.randrange(90)}, 5)")
        )
        kind = chance.choice(("solid", "solid", "drawing", "assembly"))
        lines += [
            f"  {kind} p{k}{turn} {{",
            *(f"    g{i} = {_shape(chance)}" for i in range(chance.randrange(3))),
        ]
        if chance.random() < 0.3:
            lines.append(f"    hole h {{ rim = {_shape(chance)} }}")
        lines.append("  }")
    lines.append("  constrain {")
    for _ in range(chance.randrange(5)):
        a, b = chance.sample(range(count), 2)
        relation = chance.choice((*RELATIONS, *COMPARISONS)).replace("unit", "1")
        lines.append("    " + relation.format(a=f"p{a}", b=f"p{b}", g=chance.randrange(20)))
    return "\n".join([*lines, "  }", "}"])


def _shape(chance: random.Random) -> str:
    x, y, a, b = (chance.choice((chance.randrange(-60, 60), chance.randrange(1, 9))) for _ in range(4))
    a, b = abs(a) + 1, abs(b) + 1
    return chance.choice(
        (
            f"rectangle(center: ({x}, {y}), {a}, {b})",
            f"circle(center: ({x}, {y}), radius: {a})",
            f"ellipse(center: ({x}, {y}), rx: {a}, ry: {b})",
            f'text("A{a}", center: ({x}, {y}), height: {b}, angle: {a}deg)',
            f"triangle(center: ({x}, {y}), base: {a}, height: {b})",
            f"rounded_rectangle(center: ({x}, {y}), {a}, {b}, {min(a, b) / 4})",
            f"regular_polygon(center: ({x}, {y}), radius: {a}, n: {3 + b % 9})",
            f"arc(center: ({x}, {y}), radius: {a}, start_angle: {b}deg, end_angle: {3 * b + 9}deg)",
            f"line(({x}, {y}), ({a}, {b}))",
            f"slot(start: ({x}, {y}), end: ({a}, {b}), width: {b})",
        )
    )


SOURCES: dict[str, Callable[[random.Random], str]] = {
    "soup": soup,
    "mutant": mutant,
    "calls": calls,
    "assembly": assembly,
}
_SHARES = (1, 5, 2, 2)


def program(seed: int) -> tuple[str, str]:
    """The program of a seed, and which source it is from."""
    chance = random.Random(seed)
    source = chance.choices(list(SOURCES), _SHARES)[0]
    return source, SOURCES[source](chance)
