/// Sides with gaps and minimum gaps, containment, centres.
assembly yard {
    solid house { walls = rectangle(center: (0, 0), width: 40, height: 30) }
    solid tree { crown = circle(center: (3, 2), radius: 6) }
    solid shed { walls = rectangle(center: (5, 5), width: 10, height: 8) }
    solid pond { water = ellipse(center: (1, 1), rx: 9, ry: 5) }
    drawing fence { line_around = rectangle(center: (0, 0), width: 150, height: 120) }
    solid well { rim = circle(center: (0, 0), radius: 2) }
    solid bench { seat = rectangle(center: (0, -20), width: 10, height: 4) }
    constrain {
        tree.left_of(house, gap: 5)
        tree.align_center_y(house)
        shed.right_of(house, at_least: 7)
        shed.align_top(house)
        pond.below(house, at_least: 4)
        pond.align_center_x(house)
        inside(tree, fence, margin: 3)
        contains(fence, pond, margin: 3)
        shed.within(fence)
        well.centered_in(tree)
        well.overlapping(tree)
        touching(bench, house)
    }
}
