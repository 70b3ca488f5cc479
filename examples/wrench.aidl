/// An open-ended wrench: two round heads on a bar, each with a jaw that fits a nut of its own size.
solid wrench {
    param nut_a = 13mm in 8..19  // across flats
    param nut_b = 10mm in 7..17
    param length = 140mm in 100..220  // from jaw to jaw
    let tilt = 15deg

    /// A hexagonal nut's seat, open along +x.
    hole jaw(nut = 13) {
        slot_walls = rectangle(center: (nut, 0), width: 2 * nut, height: nut)
        seat = regular_polygon(
            center: (0, 0), radius: nut / (2 * cos(30deg)), sides: 6, angle: fixed(30deg)
        )
    }

    head_a = circle(center: (-70, 0), radius: 1.15 * nut_a)
    head_b = circle(center: (70, 0), radius: 1.15 * nut_b)
    bar = rectangle(center: (0, 0), width: length, height: 0.9 * nut_b)

    jaw_a = jaw(nut: nut_a) at (-70, 0) rotated 180deg + tilt
    jaw_b = jaw(nut: nut_b) at (70, 0) rotated tilt

    constrain {
        head_a.center == bar.left.midpoint
        head_b.center == bar.right.midpoint
        jaw_a.seat.center == head_a.center - (0.35 * nut_a * cos(tilt), 0.35 * nut_a * sin(tilt))
        jaw_b.seat.center == head_b.center + (0.35 * nut_b * cos(tilt), 0.35 * nut_b * sin(tilt))
    }
}
