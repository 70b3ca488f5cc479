"""What must hold of programs that are mended unasked: no more errors than before, no constraint lost, and
nothing left to mend the second time.

`python -m tests.fuzz.mends --programs 10000 --seed 1 --texts ../shared/trial` tries so many mutants of real
programs, and ends with 1 if one of them was not mended as it should be.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from aidl_lang import pipeline
from aidl_lang.building.state import BuildingLimits
from aidl_lang.checking.complaints import IDLE
from aidl_lang.common.names import fold
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.tools.mending import mend
from aidl_lang.tools.reference.collect import reference
from tests.fuzz.judge import RECURSION, Finding, attempt
from tests.fuzz.running import Found, fuzz, options
from tests.fuzz.sources import misspelt, mutant, seeds

SETTINGS = replace(pipeline.Settings(), building=BuildingLimits(entities=8000, turns=50_000, seconds=4.0))
_MISSPELT = 0.3
"""The share of programs in which names are misspelt, with nothing else done to them."""


def program(seed: int, texts: Sequence[str]) -> str:
    """The mutant of a seed."""
    chance = random.Random(seed)
    return misspelt(chance, texts) if chance.random() < _MISSPELT else mutant(chance, texts)


def finding(text: str) -> Finding | None:
    """What is wrong with how a program is mended; None if nothing is."""
    return attempt("fix", lambda: _finding(text))


def _finding(text: str) -> Finding | None:
    before = SourceFile("fuzz.aidl", text)
    found = pipeline.check(before, settings=SETTINGS)
    mended = mend(before, settings=SETTINGS)
    if mended.source.text == text:
        return None
    after = pipeline.check(mended.source, settings=SETTINGS)
    if any(d.code.startswith("E08") for d in [*found, *after]):
        return None  # cut off: what is told is not all there is
    told = f"{', '.join(mended.fixes)}\n\n{mended.source.text}"
    errors = [sum(d.is_error for d in each) for each in (found, after)]
    if errors[1] > errors[0]:
        return Finding("fix", "more errors", f"{errors[0]} errors became {errors[1]}: {told}")
    stated = [constraining(source) for source in (before, mended.source)]
    if stated[1] < stated[0]:
        return Finding("fix", "a constraint lost", f"{stated[0]} constraints became {stated[1]}: {told}")
    again = mend(mended.source, settings=SETTINGS)
    if again.source.text != mended.source.text:
        return Finding("fix", "not idempotent", f"{told}\n\n{', '.join(again.fixes)}\n\n{again.source.text}")
    return None


def constraining(source: SourceFile) -> int:
    """How many statements of a program constrain, wish or assert, as far as it can be read. A bare call of
    what is no constraint makes something, or is nothing.
    """
    return sum(_constrains(node, False) for node in parse(source).module.statements)


def _constrains(node: ast.Node, is_demanded: bool) -> int:
    match node:
        case ast.ExpressionStatement(ast.Call(callee=callee)):
            word = fold(callee.text)
            return int(word in RELATIONS or (is_demanded and word not in IDLE))
        case ast.ExpressionStatement() | ast.Equation() | ast.Prefer() | ast.Assert():
            return 1
        case _:
            inside = is_demanded or isinstance(node, ast.Constrain)
            return sum(_constrains(child, inside) for child in ast.children(node))


RELATIONS = {
    fold(name)
    for entry in reference().entries.values()
    if entry.sort in ("constraint", "relation")
    for name in (entry.name, *entry.synonyms)
}


def main() -> int:
    parser = options(__doc__)
    parser.add_argument(
        "--texts", type=Path, action="append", default=[], help="a folder of further programs"
    )
    parser.set_defaults(programs=1000, seed=1, out=Path("build/mends"))
    arguments = parser.parse_args()
    sys.setrecursionlimit(max(sys.getrecursionlimit(), RECURSION))
    texts = [*seeds(), *(p.read_text("utf-8") for f in arguments.texts for p in sorted(f.rglob("*.aidl")))]

    def found(kind: str, text: str, seed: int) -> Found | None:
        wrong = finding(text)
        return wrong and (wrong.kind, wrong.details)

    return fuzz(arguments, lambda seed: ("mutant", program(seed, texts)), found)


if __name__ == "__main__":
    sys.exit(main())
