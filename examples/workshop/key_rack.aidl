import "key_rack.dxf" as rack
import "leaf.svg" as leaf

/// A key rack. Its plate was drawn in another program and comes as a DXF, with the holes for two screws; the leaf that is
/// engraved on it, and cut out small at both ends, is an SVG.
@thickness(6mm)
@material("birch plywood")
@title("Key rack")
solid key_rack {
    param leaf_width = 56mm in 30..64
    param pegs = 5 in 3..7

    plate = rack()

    for i in 1..pegs {
        hole peg[i] { rim = circle(radius: 4) at (30 * i, 14) }
    }
    hole left_leaf { cut = leaf.blade(width: 16, angle: 90deg) at (14, 34) }
    hole right_leaf { cut = leaf.blade(width: 16, angle: 90deg) at (166, 34) }

    drawing emblem { art = leaf(width: leaf_width) }

    constrain {
        spread(peg, inside: plate, axis: x)
        peg.bottom == plate.bottom + 8
        plate.bottom_left == (0, 0)
        emblem.art.center_x == plate.center_x
        emblem.art.midrib.center_y == 40
        left_leaf.center_x == plate.Screws.left + 2.25
        right_leaf.center_x == plate.Screws.right - 2.25
        for leaf in [left_leaf, right_leaf] { leaf.center_y == emblem.art.midrib.center_y - 6 }
    }

    assert emblem.art.top <= plate.top - 12, "the leaf runs into the hollow above it"
    assert emblem.art.bottom >= peg[1].top + 3, "the leaf comes too close to the pegs"
}
