/// gear with mounting holes
assembly gear {
    solid whole { todo }
    var rounds = 1
    var pieces = 1
    var openings = 1
    var teeth = 1

    param hole_count = 4 in 0..60
    for i in 0..<hole_count {
        @note(
            "mounting hole / mount hole / bolt hole / screw hole, mount / mounting, bolt / screw, hole; not center hole, centre hole, shaft hole, axle hole"
        )
        solid hole[i] { todo }
    }

    assert teeth >= 8, "there are at least eight teeth"
    assert openings >= 2, "at least two holes go through it, clear of the rim"
    assert abs(whole.width - whole.height) <= 0.1 * whole.width, "it is round"
    for h in hole {
        assert inside(h, whole, margin: 0.05 * whole.width), "the holes are inside"
        assert abs(h.width - hole[0].width) <= 0.05 * h.width, "the mounting holes are of one size"
    }
    assert pieces == 1, "it is one piece"

    // of any language's drawing
    assert whole.width <= 1.1 * whole.height and whole.height <= 1.1 * whole.width, "it is as wide as tall"
    assert rounds >= 3, "three round holes or more are of one size"
}
