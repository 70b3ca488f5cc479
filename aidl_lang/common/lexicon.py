"""Words that are never taken for misspellings, however near they are to a name."""

from __future__ import annotations


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
