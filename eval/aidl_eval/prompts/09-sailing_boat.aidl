/// sailing boat
assembly sailing_boat {
    solid whole { todo }
    var fields = 1
    var width_at_bottom = 1
    var width_at_quarter = 1
    var width_at_top = 1
    var pieces = 1

    @note("hull, body, boat")
    solid hull { todo }
    @note("mast, pole")
    solid mast { todo }
    param sail_count = 2 in 1..9
    for i in 0..<sail_count {
        @note("sail / mainsail / jib / foresail / genoa / spinnaker, cloth")
        solid sail[i] { todo }
    }

    assert hull.width >= 1.5 * hull.height, "the hull is long and low"
    assert mast.height >= 2 * mast.width and area(mast) <= 0.25 * mast.height * mast.height,
        "the mast is slim and upright"
    assert mast.left >= hull.left and mast.right <= hull.right, "the mast is on the boat"
    assert clearance(mast, hull) <= 0.05 * whole.height, "the mast stands on the hull"
    assert min([clearance(s, mast) for s in sail]) <= 0.02 * whole.width, "a sail is on the mast"
    for s in sail {
        assert clearance(s, mast) <= 0.12 * whole.width, "no sail is far off the mast"
        assert s.bottom >= hull.center_y, "the sails are above the hull"
        assert s.top <= mast.top + 0.05 * mast.height, "the sails do not rise above the mast"
    }
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert width_at_top <= 0.4 * max(width_at_bottom, width_at_quarter), "it ends in a narrow top"
    assert fields >= 3, "three fields or more are seen"
}
