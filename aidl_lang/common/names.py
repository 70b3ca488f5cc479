"""Names as people and models spell them: lookup without regard to case and underscores, and suggestions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import accumulate
from typing import TypeVar

# --- Words that are never taken for misspellings, however near they are to a name.


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


WORDS = _words("""
about above abs abuts acos across add adjacent af after alias align aligned alignment aligns alike all along
alongside alpha amid amount anchor anchored and angle angled angles annotation annular annulus another
anticlockwise any apart apothem arc arccos arcsin arctan are area arm arms around arrange array arrow as
asin assembly assert at atan atop away axis axle back barrier base baseline bases basket be beam bearing
bearings beating before begin behind below belt bend beneath beside between beveled beyond bezier big bigger
bl block blocks body bolt bolts bool boolean border bore bores boss bosses both bottom bottoms box boxes br
bracket build butt by cam cams cap caps capsule caption captive carrier ccw ceil center centered centers
centre centred chain chamfer chamfered channel check chevron choice circle circles circular circumcenter
circumradius class clearance clip clockwise close closepath clover cm coaxial coincide coincident colinear
collar collinear color colour column columns component concave concentric cone congruent constr constrain
constraint constraints construction contact contain contained contains content continues control convex
coordinate coordinates coords copies copy core corner corners cos cosine cotter count counterbore
counterclockwise countersink cover create crescent cross crosses ctr cube curve curved curves cut cutout
cutter cw cx cy cylinder deep deeper def defs deg degrees depth design detached dia diam diameter diameters
diamond difference different dir direction disc disk dist distance distances distribute distributed dogbone
donut dot double doughnut down draw drawing drop dx dy each east eccentric edge edges egg element elevation
ellipse else encloses end ending ends engraving ensure entering enumerate equal equally equals equidistant
equilateral error even evenly every export extent external extrude eye eyes face faces false far farthest
feet fewer fill filldraw filled fillet finger fingers first fits fix fixed flange flat flats flex floor flush
fn folder font foot for foreach forward four frame frames free from front ft function fuse gap gaps gear gears
geometry get glyphs greater grid groove ground grounded group guess guide half halfway halign handle handles
has have head headed heading heart height heights hex hexagon high higher hinge hline holder hole holes hook
hooks horizontal horizontally house hub hubs hull hypot id if image images import in incenter include index
ink inner inradius inset inside integer internal intersect intersecting intersection into involute is
isosceles jaw jaws joins justify keeps kerf key keyhole keys kind kinds kite knob knobs label large larger
last lattice layer layout leading least leaving left lefts leg legs len length lengths lens lerp less let
letter lettering level lever lid lids lies like line linear lined lines lineto link links lip lips list
little living loc location lock loft long longer lower lune major make margin marker matched material math
max maximum maxx maxy mechanism meets mesh meshes message mid middle midpoint min minimum minkowski minor
minx miny mirror mirrored miter mm mod model module moon more most motor mount move moveto narrow narrower
near nearest neck negative nema new next ngon no node non none norm normal north not note np null num number
numpy nut nuts oblong obround octagon od of offset on only onto opacity opening opposite or order
orientation origin orthogonal other out outer outline outset outside oval over overall overlap overlapping
overlaps own pa padding panel panels parallel parallelogram param part parted path pattern peer peers
pentagon perimeter perpendicular phi pi pie piece pill pin pins piscis pitch place placed plate plates plus
pocket point points polar polygon polyline pos position positive prefer pressure previous primitive print
prism product profile pt pts pulley quad quadrant quadratic quarter rack rad radians radii radius range
raspberry rear record rect rectangle rectilinear reference refuse regular relief render require rests return
reuleaux reversed revolve rhombus ri rib ribs right rights rim rims ring rings ro roll room rot rotate
rotated rotation round rounded rounding row rows rx ry same save scale screw screws seat sector segment self
semi semicircle sense separate separation set shade shaft shape share shared sharp shell shift short shorter
shoulder show shown side sides similar sin sine sits size sizes sketch sleeve slice slide slider slides
slope slopes slot slots small smaller smooth smoothly solid south space spaced spacer spacing span sphere
spider spline spoke spokes spread spring spur sqrt square squarely squircle stack stacked stadium stands
star start step stepper steps stop stopper stops str strap stretch string stroke structure subassembly
subtract sum superellipse surrounds sweep swing symbol symmetric symmetrical symmetry system tab tabs tail
tall taller tan tangent tangential tap tapered tapped teardrop teeth template text than the then theta thick
thicker thickness thin thinner through tilt times tiny tips tl to todo tolerance tongue tooth top tops torus
total touch touches touching toward towards tr transform translate trap trapezium trapezoid triangle true
turn turned two under underneath unequal union unit unwound up upon upper upright use value var vec vector
vert vertex vertical vertically vertices verts vesa vesica via viewport vline void wall walls washer way
wedge weight west wheel wheels where wide wider width widths with within without word words working
workplane written xmax xmin xshift ymax ymin yshift zip
""")
"""Words that say something of a drawing: those in the names of the language and the library, those of the
tables of synonyms, and those that other languages and people have for the same things. Names that differ in
one of them mean different things."""

NEAR_WORDS = _words("""
aground alighted alined alinement angel angels anglers annexation annuls anther asset assigned assignment
authored baring barrener barrings bashes basses bastes bating beaching bearding beatings beavered bedside
beetling behaving belaying bellow bequeath berating berrying berthing betaking bevelled bewaring biases
blackest blasting bleating bloating blot blots blurrier boarder boarding boasting borer borers boxers
bracelet breading breaking cambered cankered cantered captained captains caresses carouses cation censored
censured centaurs chanters chartered chattered cheaters cindered circlets circuses clambered clasps clutter
colander commonest competent conceive conclave confident confined confines confluent conjoined conjoins
constant constants constrains constrict constriction constricts contacted contacts contempt continued
continuous continuums contract contraction contrail contrails contrast contrived convinces coordinators
copes copiers cords cornier coroner coroners coronets countered counters countersank countersunk couriers
crate cratered cremate crocuses crooners crosiers cured cures curtained curtains cuter dad debauched
defection deference degrades deign dejection detailed detained detected detection detracted diabetes
diffidence diffident digestion dissection distaste distastes drafting dragging draining drawling dreading
dreaming drowning drowsing eats election enclaves encoring endearing enduing enduring enervation engaging
enraging enslaving ensue ensuring enticing enumerable enure equality est eternal facets faeces farces
fattiest filet finer fist floats foreword form fraction framers friction fro furthest gasp gird grater
greasier grouched grove guests haling handlers handsets headlong heptagon hoarding inaner infernal insect
insert integral intellect intenser intensest interact interacting interaction intercept intercepting
interception interdict interdicting interdiction interest interesting interject interjecting interjection
interment internet interval intervention inventor inviolate joints lactation lading lager lathering lats
lawyer leaching leaguing learning leashing lecturing legation leis levering libation lien liens limned
linens liner liners linked linted lisp littering locution loitering loner maid maker malarial manorial
maternal metes misprint mister mono nay nuder ops ostentation ouster outshine overalls overeats overfull
overhaul overkill overlaying overlays overlies overloads overpass overpays overplays oversell paced paddling
palace palate palates panes parading parameter pared partied pates peddling pedometer peters petition
piddling pierce pints plaice platens pleasure plodding poplar positron prated precious previews prodding
puddling punitive purism quainter radiates radicals ram rams recessed refereed referred refunded refunding
rehearsed relation released reserved resets restated reuse revealed revelled revenged revered reverence
reverend reverted riverbed rotted rotund roughing routeing sacked sands satrap sawing scimitar sediment
seizes separable sewing shackled shard sharked sharped sheared shred shrift sidles slacking sliders slier
sloppier sloths sluice smacking smellier smoothy smoulder snacking solacing solider sooth sorter sowing
spacier spamming spanking spanning sparing sparking sparring spatting spawning speaking spearing speccing
specking spine splaying splice splicing sporing sportier spraying sprig sprucing squiggle stacking staked
stanched starched staring steeper steeps sting stoke stolid stomps stoops stopover storing strands stricture
stripper strops sue summitry surmounts tampered tangiest taped tarp tattered teaching temperate tempered
thickeners thickens thickets thorough though ticker timers tolerable tolerate torching toughens tours
tousling tow transmute trapped trickier trickiness trough trucking tsar tuned unison verdicts verities
vertexes verticals vestiges viewpoint vortices wedgie wets wight wilder won workplace worlds worrying
worsting
""")
"""English words one slip away from one of WORDS."""


T = TypeVar("T")

_NUMBER = re.compile(r"\d+")
_HUMP = re.compile(r"(?<=[a-z\d])(?=[A-Z])")
_FEWEST_LETTERS = 3
"""Letters that a name must have before a near one is taken for it without asking."""
_WIDER = 6
"""Names beyond the count asked for that are compared letter by letter."""
_MOST_LETTERS = 200_000
"""Pairs of letters that one search for a name compares: enough for some hundred names of ordinary length."""


def folded(text: str) -> str:
    """Returns the form that `CenterInside`, `centerInside` and `center_inside` have in common."""
    return text.replace("_", "").casefold()


fold = lru_cache(maxsize=4096)(folded)
"""The same for names, which are remembered, as whole programs are not."""


def find(name: str, table: Mapping[str, T]) -> str | None:
    """Returns the key of `table` that `name` means: as written if it is there, else the one that folds alike.

    None if there is none, or if two keys fold alike and neither is written so.
    """
    return name if name in table else Spellings(table).find(name)


_OPPOSITES = tuple(
    tuple(tuple(words.split()) for words in line.split(" | "))
    for line in """
smaller narrower shorter less fewer thinner | larger bigger wider taller longer greater more thicker
small narrow short thin | large big wide tall long thick
lower under below beneath | higher over above upper
left | right
top | bottom
up | down
inside inner within | outside outer
inset | outset
in | out
horizontal horizontally level | vertical vertically upright
parallel | perpendicular
start first begin | end last
min minimum | max maximum
minor | major
near nearest | far farthest
row | column
rows | columns
front | back
before | after
most | least
same equal | different unequal
convex | concave
concentric | eccentric excentric exzentrisch
contains containing | contained
encloses | enclosed
surrounds surrounding | surrounded
clockwise cw | counterclockwise anticlockwise ccw
internal | external
union add | difference subtract
hole | solid
x rx dx cx | y ry dy cy
x1 x2 | y1 y2
width | height
positive | negative
""".strip().splitlines()
)
"""Words that mean the reverse of those on the other side of the bar, or its counterpart."""
_TURNING = ("no", "not", "non", "never", "without", "by")
"""Words that reverse the meaning of the rest."""
_REVERSING = tuple("un de dis mis anti counter off none opposite reverse reversed inverse inverted".split())
"""Words that make another thing of a name, wherever they stand in it."""
_PART_OF_A_NAME = 4
"""Letters that a word must have to be recognised inside a longer one: `alignleft`."""


_DENYING = tuple("a an anti counter de des dis ex il im in ir mis no non not off out un".split())
"""Syllables that reverse a word when they stand before it."""
_DENYING_ALL = tuple(x for x in _DENYING if x not in ("a", "an", "in"))
"""Those of them with which few words begin by chance."""


def are_opposite(a: str, b: str) -> bool:
    """Tells whether two names differ by a word and its reverse, as `align_left` and `align_right` do, or one
    denies or reverses the other: `no_overlap`, `contained_by`, `asymmetric`.
    """
    words, others = {fold(a), *_words_of(a)}, {fold(b), *_words_of(b)}
    if any(_says(a, word) != _says(b, word) for word in _TURNING) or any(
        _denies(x, y) or _denies(y, x)
        for x, y in [(fold(a), fold(b)), *((x, y) for x in words - others for y in others - words)]
    ):
        return True
    return any(
        any(_says(a, w) and not _says(b, w) for w in here)
        and any(_says(b, w) and not _says(a, w) for w in there)
        for pair in _OPPOSITES
        for here, there in (pair, pair[::-1])
    )


def _loses_sense(name: str, other: str) -> bool:
    """Tells whether another name leaves out what reverses a name, or says which of two reverses is meant:
    `offset_in` is no `offset`, `touchless` no `touches`, and the `n` of `n_overlap` may be a `no`.
    """
    words, others = _words_of(name), _words_of(other)
    if any(
        (word in _REVERSING and word not in others)
        or (len(word) > _PART_OF_A_NAME + 1 and word.endswith("less") and not other.endswith("less"))
        or (word not in WORDS and any(_is_denied(word, before, others[0]) for before in _DENYING_ALL))
        for word in words
    ):
        return True
    first = words[0]
    has_more = len(words) > len(others) and first not in others and (first not in WORDS or first == "on")
    if has_more and any(_distance(first, word) <= 1 for word in ("no", "not", "non")):
        return True
    sides = [{word for side in pair for word in side if len(word) > 1} for pair in _OPPOSITES]
    return any(not both.isdisjoint(words) and not any(_says(other, w) for w in both) for both in sides)


def _is_denied(word: str, before: str, other: str) -> bool:
    """Tells whether a word is a known one behind a syllable that reverses it, which another has not."""
    rest = word.removeprefix(before)
    return rest != word and len(rest) >= _PART_OF_A_NAME and rest in WORDS and not other.startswith(before)


def _denies(a: str, b: str) -> bool:
    """Tells whether a word is another, or a form of it, behind a syllable that reverses it, as `un`."""
    rests = (a[len(before) :] for before in _DENYING if a.startswith(before) and not b.startswith(before))
    return any(rest == b or (len(rest) > _PART_OF_A_NAME and rest[:3] == b[:3]) for rest in rests)


def _words_of(name: str) -> list[str]:
    """Returns the words of a name, between underscores or with capitals."""
    return _HUMP.sub("_", name).casefold().split("_")


def _says(name: str, word: str) -> bool:
    return word in fold(name) if len(word) >= _PART_OF_A_NAME else word in _words_of(name)


def means_otherwise(name: str, other: str) -> bool:
    """Tells whether two names differ in words of unlike meaning: `same_side` and `same_size`."""
    return any(
        a in WORDS and b in WORDS and not _are_forms(a, b) for a, b in _differing(name, other) if a and b
    )


def _differing(name: str, other: str) -> list[tuple[str, str]]:
    """Returns the pairs of unlike words of two names, place by place; empty if the names differ in length."""
    words, others = _words_of(name), _words_of(other)
    return [(a, b) for a, b in zip(words, others, strict=True) if a != b] if len(words) == len(others) else []


def _are_forms(a: str, b: str) -> bool:
    """Tells whether two words are forms of one: `center`, `centre`, `centers`, `centered`."""
    a, b = (word.replace("centre", "center").replace("centr", "center") for word in (a, b))
    return not {a, _ENDING.sub("", a)}.isdisjoint((b, _ENDING.sub("", b)))


_ENDING = re.compile(r"(?:e?s|e?d)$")


class Spellings:
    """A growing table of names that answers `find` without looking through the whole of it each time."""

    def __init__(self, table: Mapping[str, object]) -> None:
        self._table = table
        self._known = 0
        self._alike: dict[str, list[str]] = {}

    def find(self, name: str) -> str | None:
        if name in self._table:
            return name
        if len(self._table) != self._known:
            self._known = len(self._table)
            self._alike = {}
            for key in self._table:
                self._alike.setdefault(fold(key), []).append(key)
        alike = self._alike.get(fold(name), ())
        return alike[0] if len(alike) == 1 else None


def nearest(name: str, known: Iterable[str], count: int = 1) -> list[str]:
    """Returns known names that `name` may be a misspelling of, best first; none that means the reverse, or is
    another word. A single letter is a misspelling of nothing.
    """
    if len(name) < 2:
        return []
    folded: dict[str, str] = {}
    for key in known:
        folded.setdefault(fold(key), key)
    likeness = 0.6 if len(name) < 5 else 0.7  # one wrong letter weighs more in a short name
    wanted = fold(name)
    most = _MOST_LETTERS // max(len(wanted), 1)
    from difflib import get_close_matches  # most programs are spelled right

    found = get_close_matches(wanted, _within(folded, len(wanted), most), n=count + _WIDER, cutoff=likeness)
    matches = [match for match in found if _may_be_meant(name, folded[match])]
    matches.sort(key=lambda match: _distance(wanted, match))
    best = [folded[match] for match in matches[:2]]
    if (
        len(best) == 2
        and are_opposite(*best)
        and len({_distance(wanted, match) for match in matches[:2]}) == 1
    ):
        return []  # `align_center_z`
    if not matches and len(wanted) >= _PART_OF_A_NAME:  # an abbreviation: `perp`
        longer = (key for key in folded if key.startswith(wanted) and not are_opposite(name, folded[key]))
        matches = sorted(longer, key=len)
    return [folded[match] for match in matches[:count]]


def _may_be_meant(name: str, other: str) -> bool:
    """Tells whether a name is near enough to another, in letters and meaning, to be meant by it."""
    if are_opposite(name, other) or means_otherwise(name, other) or _loses_sense(name, other):
        return False
    wanted, match = fold(name), fold(other)
    if wanted in match or wanted.startswith(match):
        return True
    if match in wanted:
        return len(wanted) <= len(match) + 2
    if len(wanted) < _SHORT and wanted[0] != match[0]:
        return False
    pairs = [(wanted, match), *_differing(name, other)]
    return all(_distance(a, b) <= max(1, len(a) // 3) for a, b in pairs)


def _within(names: Mapping[str, str], length: int, letters: int) -> list[str]:
    """Returns the names whose length is nearest to `length`, as many as have so many letters together."""
    by_length = sorted(names, key=lambda each: abs(len(each) - length))
    ends = accumulate(map(len, by_length))
    return [each for each, end in zip(by_length, ends, strict=True) if end <= letters]


def is_spelled_in(letters: str, word: str) -> bool:
    """Tells whether letters occur in a word in their order, as when somebody types some of them."""
    rest = iter(fold(word))
    return all(letter in rest for letter in fold(letters))


def is_like(name: str, meant: str) -> bool:
    """Tells whether a name is near enough to the other to be replaced by it on request: a letter wrong,
    missing, too many or exchanged with its neighbour; two in a long name, but not in a short word of it. Not
    if it has a word more (`same_center_x`), another number (`hole3`, `hole2`), or only one or two letters
    (`x10`, `s10`).
    """
    if fold(name) == fold(meant):
        return True
    if _NUMBER.findall(name) != _NUMBER.findall(meant) or sum(map(str.isalpha, name)) < _FEWEST_LETTERS:
        return False
    words, others = _words_of(name), _words_of(meant)
    if len(words) != len(others) or _distance(fold(name), fold(meant)) > _most_slips(fold(name)):
        return False
    return all(_distance(x, y) <= _most_slips(x) for x, y in zip(words, others, strict=True))


def is_slip(name: str, meant: str) -> bool:
    """Tells whether a name is certainly a slip for another, so that nobody need be asked: it is like it, and
    the words in which they differ are no words as written, but slips of the pen.
    """
    if not is_like(name, meant) or are_opposite(name, meant):
        return False
    return fold(name) == fold(meant) or all(_is_slip_in(a, b) for a, b in _differing(name, meant))


def _is_slip_in(written: str, word: str) -> bool:
    """Tells whether a word is certainly a slip for another: letters exchanged, one doubled or not, one
    missing or too many within the word, or in a long word another one there. A short word may be another
    word, and so may one with another beginning or ending: `fat` and `flat`, `plate` and `slate`, `bolt` and
    `bolts`.
    """
    if written in WORDS or written in NEAR_WORDS or min(len(written), len(word)) < _FEWEST_LETTERS:
        return False
    if sorted(written) == sorted(word):
        return True
    if _are_forms(written, word) or written[0] != word[0] or min(len(written), len(word)) < _SHORT:
        return False
    if _LETTERS.sub(r"\1", written) == _LETTERS.sub(r"\1", word):
        return True
    if word[:-1] == written and len(written) > _SHORT and word[-1] not in _INFLECTIONS:
        return True
    has_end = written[-1] == word[-1]
    return has_end and (len(written) != len(word) or len(written) >= _LONG)


_LETTERS = re.compile(r"(.)\1+")
_INFLECTIONS = "sdry"
"""Letters whose addition makes another form of a word."""
_SHORT, _LONG = 5, 8
"""Letters that a word must have for one missing letter, and for one wrong letter, to be a mere slip."""


def _most_slips(word: str) -> int:
    return 1 if len(word) < 8 else 2


def _distance(a: str, b: str) -> int:
    """Returns the number of slips between two words; a letter one place off counts once."""
    above: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        further, above, row = above, row, [i]
        for j, y in enumerate(b, 1):
            row.append(min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (x != y)))
            if i > 1 and j > 1 and x == b[j - 2] and y == a[i - 2]:
                row[j] = min(row[j], further[j - 2] + 1)
    return row[-1]
