"""What is offered for a name that is unknown, as fix or as "did you mean", never means the opposite."""

from __future__ import annotations

import random
import re

import pytest

from aidl_lang.checking import library
from aidl_lang.common.names import is_slip, nearest
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import check
from tests.amount import TRIES_ALL

DENIED = """
asymmetric asymmetrical asymetric unsymmetric dissymmetric nonsymmetric antisymmetric decentered_in
decentred_in uncentered_in offcentered_in eccentric excentric exzentrisch excentrique nonparallel unparallel
antiparallel aparallel nonperpendicular unperpendicular nontangent untangent detangent untouching
nontouching nottouching NotTouching noTouch untouched unequal inequal nonequal notequal NotEqual disequal
misaligned unaligned disaligned nonaligned misalign_left unalign_left MisalignLeft nonconcentric
unconcentric noncoincident unfix uncoincident discoincident incoincident unlock anticlockwise nonhorizontal
unhorizontal nonvertical unvertical touchless meshless un_coincide in_collinear un_right_of
parallel_inverse tangent_reversed equal_opposite excenter_of dis_tangent n_overlap on_overlap nn_overlapping
surrounded
"""
"""Names that deny what one in the library says."""
FOREIGN = """
links gauche izquierda sinistra linksvon align_links align_gauche: right
rechts droite derecha destra rechtsvon align_rechts align_droite: left
oben ueber dessus arriba sopra obenauf oberhalb align_haut: below bottom under lower
unten unter dessous abajo sotto unterhalb align_bas: above top over upper
innerhalb dedans adentro interno interieur: outside outer
ausserhalb dehors afuera esterno exterieur: inside inner
waagerecht horizontalement orizzontale: vertical
senkrecht lotrecht verticalement verticale: horizontal parallel
parallele paralelo parallelamente: perpendicular
perpendiculaire perpendicolare perpendicular_a: parallel
kleiner schmaler niedriger menor minore: larger wider taller bigger
groesser breiter hoeher mayor maggiore: smaller narrower shorter
"""
"""Words of other languages, and what must not be offered for them."""
REVERSED = """
left right, top bottom, above below, over under, inside outside, horizontal vertical, horizontally vertically,
wider narrower, taller shorter, larger smaller, parallel perpendicular, width height, row column, start end,
min max, contains contained, encloses enclosed, upper lower, most least, in out, inner outer, larger smaller
"""


def offered(names: list[str]) -> dict[str, str]:
    """What is offered for each name that is unknown."""
    found: dict[str, str] = {}
    for start in range(0, len(names), 10):
        calls = "\n".join(f"        {name}(a, b)" for name in names[start : start + 10])
        things = "a = rectangle(width: 5, height: 4)\n    b = circle(radius: 3)"
        text = f"drawing d {{\n    {things}\n    constrain {{\n{calls}\n    }}\n}}\n"
        for finding in check(SourceFile("s.aidl", text)):
            if finding.code == "E0203" and finding.span is not None:
                fixed = [e.replacement for e in finding.fix.edits] if finding.fix is not None else []
                asked = re.findall(r"did you mean `(\w+)`", finding.message)
                found[finding.span.text] = " ".join([*asked, *fixed])
    return found


def test_what_denies_a_name_is_not_that() -> None:
    found = offered(DENIED.split())
    assert len(found) > 50
    assert {name: said for name, said in found.items() if said} == {}


@pytest.mark.parametrize("line", FOREIGN.strip().splitlines())
def test_a_word_of_another_language(line: str) -> None:
    words, _, reverses = line.partition(": ")
    for word, said in offered(words.split()).items():
        assert not set(re.split(r"[_ ]", said)) & set(reverses.split()), (word, said)


def misspelt() -> list[tuple[str, str]]:
    """Names of the library in which a word has a reverse, with a letter wrong, missing, doubled or exchanged,
    and the names themselves.
    """
    chance, pairs = random.Random(4), REVERSED.replace(",", "").split()
    names = sorted(n for n in library.load().callables if set(n.split("_")) & set(pairs) and len(n) > 4)
    found = []
    for name in names:
        for _ in range(3 if TRIES_ALL else 1):
            k = chance.randrange(len(name) - 1)
            rest = name[k + 2 :]
            changed = (name[k + 1] + rest, 2 * name[k] + name[k + 1] + rest, name[k + 1] + name[k] + rest)
            found.append((name[:k] + chance.choice((*changed, f"e{name[k + 1]}{rest}")), name))
    return [(slip, name) for slip, name in dict(found).items() if re.fullmatch(r"[a-z]\w*[a-z]", slip)]


def test_a_slip_that_may_be_for_either_of_two_reverses() -> None:
    assert not any(offered(["align_center_z", "align_centers_", "equal_center_j"]).values())


@pytest.mark.parametrize("name", ["offset_in", "offset_out", "turned_right", "max_distance", "inner_ring_"])
def test_a_side_is_not_left_out(name: str) -> None:
    assert nearest(name, ["offset", "turned", "x_distance", "ring"]) == []


def test_what_is_no_condition_is_not_offered_as_one() -> None:
    assert offered(["squrt", "floo"]) == {"squrt": "", "floo": ""}


def test_a_slip() -> None:
    meant = dict(misspelt())
    found = offered(list(meant))
    assert len(found) > (100 if TRIES_ALL else 40)
    right = 0
    for slip, said in found.items():
        words = set(re.split(r"[_ ]", said))
        right += meant[slip] in said.split()
        for a, b in (pair.split() for pair in REVERSED.split(",")):
            own = {a, b} & set(meant[slip].split("_"))
            assert len(own) != 1 or not words & ({a, b} - own), (slip, meant[slip], said)
    assert right > 0.8 * len(found)


SLIPS = "raduis radius, gpa gap, Hole_2 hole2, hloe2 hole2, part_nmber_7 part_number_7, rectanlge rectangle"
OTHERS = "hole3 hole2, hole hole2, plate12 plate21, x10 s10, i pi, l1 r1, ab ac, same_center_x same_center"


def test_a_letter_that_is_wrong_is_no_other_name() -> None:
    assert all(is_slip(*pair.split()) for pair in SLIPS.split(", "))
    assert not any(is_slip(*pair.split()) for pair in OTHERS.split(", "))


@pytest.mark.parametrize("name", ["hole3", "hole12"])
def test_a_member_that_is_not_there_is_no_other_member(name: str) -> None:
    text = (
        "solid s {\n    hole1 = circle(radius: 3)\n    hole2 = circle(center: (9, 0), radius: 3)\n"
        f"    constrain {name}.radius == 4\n}}\n"
    )
    (found,) = [d for d in check(SourceFile("s.aidl", text)) if d.code == "E0201"]
    assert found.fix is None
    assert "did you mean `hole" in found.message
