"""Synonyms of arguments and members, in tables for the checker, the interpreter and the printer.

They are consulted only if no overload, or no member, is spelled as written (case and underscores aside). In
`MEMBERS` a word stands for the first of its meanings that is there; in `PARAMETERS` it has to be the only one
that is there and not given otherwise, else the call is ambiguous.
"""

from __future__ import annotations

from collections.abc import Mapping

from aidl_lang.common.names import fold

_PARAMETERS = """
radius: r rad
r: radius
outer_radius inner_radius: radius r rad r1 r2 radius1 radius2
outer_radius: r_outer r_out ro r_o outer outer_r radius_outer outside_radius major_radius max_radius
inner_radius: r_inner r_in ri r_i inner inner_r radius_inner inside_radius minor_radius min_radius
diameter: d dia diam
d: diameter dia distance amount by
outer_diameter inner_diameter: d dia diameter
outer_diameter: od d_outer outer_d outer_dia outside_diameter diameter_outer
inner_diameter: id d_inner inner_d inner_dia inside_diameter diameter_inner bore
width: w wide
w: width
height: h tall
h: height
width height: thickness thick
size: side side_length edge edge_length a s
bottom_width: bottom base base_width width_bottom bottom_length
top_width: top width_top top_length
base: b width base_width
thickness: t thick wall wall_thickness border
radius: circumradius
inradius: apothem inner_radius
side: s edge edge_length side_length
across_flats: flat_to_flat flats af
bottom_left: lower_left left_bottom bl min corner
bottom_right: lower_right right_bottom br
top_left: upper_left left_top tl
top_right: upper_right right_top tr max
top_center: top top_middle top_mid middle_top mid_top
bottom_center: bottom bottom_middle bottom_mid middle_bottom mid_bottom
left_center: left left_middle left_mid middle_left mid_left
right_center: right right_middle right_mid middle_right mid_right
left: min_x x_min xmin minx
right: max_x x_max xmax maxx
bottom: min_y y_min ymin miny
top: max_y y_max ymax maxy
rx: x_radius radius_x r_x semi_major a
ry: y_radius radius_y r_y semi_minor b
center: centre ctr c middle pos position at loc location
at: position pos location
start: p1 from start_point begin first p_start pt1 point1 a
end: p2 p3 to end_point stop last p_end pt2 point2 b
mid: middle through via p2 point_on
p0: start from
p1: control1 c1 start_control
p2: control2 c2 end_control
p3: end to
from: start start_point begin
angle: rot rotation theta orientation tilt phi deg degrees
start_angle: start a1 angle1 from_angle begin_angle from
end_angle: end a2 angle2 to_angle stop_angle to
length: len l overall_length total_length
distance: d by amount offset
gap: spacing distance space by separation offset
at_least: min_gap minimum min min_distance
gap at_least: clearance margin
margin: padding clearance inset border gap offset
inset: offset margin
spacing: gap pitch
pitch: spacing gap
sides: n count num number number_of_sides side_count num_sides n_sides
teeth: n count num number number_of_teeth num_teeth n_teeth tooth_count z
points: n count num number number_of_points num_points n_points point_count tips
n: count num number times copies
count: n num number times copies
points: vertices verts corners pts coords coordinates
corner_radius: r radius rounding fillet
radius: corner_radius fillet rounding corner corner_r fillet_radius rounding_radius
module: m mod
pressure_angle: pa alpha
axis: direction dir along
align: alignment justify anchor halign text_anchor
height: size font_size text_size letter_height cap_height
text: string label content message caption
line_spacing: leading line_height
about: axis across mirror_line line
value: v amount equals distance length angle theta degrees deg
clockwise: cw
ccw: counterclockwise anticlockwise
inside: internal
large: large_arc
"""
"""`meanings: words`; a word in several lines has all their meanings."""

_MEMBERS = """
radius: r rad
diameter: d dia diam
center: centre ctr c middle mid position pos origin
midpoint: mid middle mid_point center_point
width: w
height: h
start: p1 from start_point begin first
end: p2 to end_point stop last
p1: control1 c1
p2: control2 c2
length: len
angle: rot rotation theta rotate orientation tilt
rx: x_radius radius_x
ry: y_radius radius_y
sweep: sweep_angle angle
center_x: cx x_center mid_x
center_y: cy y_center mid_y
left: min_x x_min xmin minx left_x left_edge
right: max_x x_max xmax maxx right_x right_edge
bottom: min_y y_min ymin miny bottom_y bottom_edge
top: max_y y_max ymax maxy top_y top_edge
bottom_left: min lower_left bl left_bottom
bottom_right: lower_right br right_bottom
top_left: upper_left tl left_top
top_right: max upper_right tr right_top
top_center: top_mid top_middle center_top mid_top
bottom_center: bottom_mid bottom_middle center_bottom mid_bottom
left_center: left_mid left_middle center_left mid_left
right_center: right_mid right_middle center_right mid_right
corner: vertices vertex corners
corner: points
"""


def _read(table: str) -> Mapping[str, tuple[str, ...]]:
    """Returns folded word → its meanings, in the order of the lines."""
    found: dict[str, dict[str, None]] = {}
    for line in table.strip().splitlines():
        meanings, _, words = line.partition(": ")
        for word in words.split():
            found.setdefault(fold(word), {}).update(dict.fromkeys(meanings.split()))
    return {word: tuple(meanings) for word, meanings in found.items()}


PARAMETERS = _read(_PARAMETERS)
MEMBERS = _read(_MEMBERS)

FIELDS = frozenset(MEMBERS) | {fold(m) for meanings in MEMBERS.values() for m in meanings}
"""All words that may name a field, folded."""

PAIRS: Mapping[str, tuple[str, str]] = {
    "size": ("width", "height"),
    "dimensions": ("width", "height"),
    "dims": ("width", "height"),
    "radii": ("rx", "ry"),
}
"""An argument of two numbers that stands for two parameters: `size: (40, 20)`."""

COORDINATES: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("x", "y", ("center", "at")),
    ("cx", "cy", ("center",)),
    ("centerx", "centery", ("center",)),
    ("x1", "y1", ("start",)),
    ("x2", "y2", ("end",)),
)
"""Two folded names that together give one point, and the parameters it may be."""
