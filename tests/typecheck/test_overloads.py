"""The choice among overloads: what spares it work changes nothing, and no program marks the next."""

from __future__ import annotations

from itertools import combinations

from aidl_lang import pipeline
from aidl_lang.checking import library
from aidl_lang.checking.builtins import SIGNATURES
from aidl_lang.checking.types import Binding, GivenArgument, Signature, bind
from aidl_lang.common.names import fold
from aidl_lang.common.source import SourceFile


def codes(text: str) -> list[str]:
    return [d.code for d in pipeline.check(SourceFile("program.aidl", text))]


def calls(signature: Signature) -> list[list[GivenArgument]]:
    """Arguments of the right types: any number of them without a name, and by name the rest, or all but one
    or two of it.
    """
    found = []
    for split in range(len(signature.parameters) + 1):
        first = [GivenArgument(None, kind) for _, kind, _ in signature.parameters[:split]]
        rest = [GivenArgument(name, kind) for name, kind, _ in signature.parameters[split:]]
        for left_out in range(3):
            named = combinations(rest, max(0, len(rest) - left_out))
            found += [[*first, *some] for some in named]
    return found


def test_the_quick_look_turns_away_nothing_that_fits() -> None:
    tables = (SIGNATURES, library.load().callables)
    everything = [s for table in tables for overloads in table.values() for s in overloads]
    fitting = 0
    for signature in everything:
        for given in calls(signature):
            if isinstance(bind(signature, given), Binding):
                words = {fold(g.name) for g in given if g.name is not None}
                assert signature.may_take(sum(g.name is None for g in given), words), (str(signature), given)
                fitting += 1
    assert fitting > len(everything)


def test_a_definition_of_one_program_is_not_met_in_the_next() -> None:
    wrong = "solid part { disc = circle(flavour: 3) }"
    own = "shape circle(flavour: length) { rim = line((0, 0), (flavour, 0)) }\n" + wrong
    before = codes(wrong)
    assert before == ["E0324"]
    assert "E0324" not in codes(own)
    assert codes(wrong) == before
