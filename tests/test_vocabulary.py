"""The words of the language: what is promised exists, and what exists is documented and tried."""

from __future__ import annotations

import pytest

from aidl_lang.checking import library
from aidl_lang.checking.builtins import SIGNATURES

PROMISED = {
    "geometry": "point line arc circle bezier ellipse",
    "shapes": """
        rectangle square rounded_rectangle chamfered_rectangle triangle trapezoid parallelogram rhombus kite
        regular_polygon polygon polyline star slot arc_slot ring sector segment gear cross arrow
        keyhole capsule heart
        drop crescent path text
    """,
    "operations": """
        move rotate scale mirror copy offset shell hull thick intersect clip fillet chamfer
        linear_array grid polar_array along
    """,
    "constraints": """
        coincident horizontal vertical parallel perpendicular collinear concentric tangent equal equal_length
        equal_radius midpoint symmetric fixed distance horizontal_distance vertical_distance angle
        length radius
        diameter mirror_of
    """,
    "relations": """
        above below left_of right_of on_top_of stacked_on inside contains centered_in center_inside
        centered_horizontally centered_vertically align_left align_right align_top align_bottom align_center_x
        align_center_y same_width same_height same_size wider taller narrower shorter row column evenly_spaced
        touching no_overlap overlapping
    """,
    "placement": """
        on_circle at_corners spread between anchor vertical_through horizontal_through clearance
    """,
    "path": """
        line_to line_by up down left right arc_to arc_by tangent_arc_to bezier_to close spline
        rectilinear_polygon
    """,
    "functions": """
        sin cos tan asin acos atan atan2 sqrt abs norm square min max hypot floor ceil round dot
        cross unit lerp
        polar midpoint len sum area perimeter overlaps guess written record enumerate zip range
    """,
    "synonyms": """
        orthogonal square_to over under beneath underneath translate rect annulus diamond stadium
    """,
}


@pytest.mark.parametrize("topic", PROMISED)
def test_promised_names_exist(topic: str) -> None:
    known = library.load()
    words = PROMISED[topic].split()
    missing = [
        w for w in words if w not in known.callables and w not in known.aliases and w not in SIGNATURES
    ]
    assert missing == []
