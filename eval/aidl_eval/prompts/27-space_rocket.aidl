/// space rocket
assembly space_rocket {
    solid whole { todo }
    var symmetry = 1
    var fields = 1
    var width_at_middle = 1
    var width_at_top = 1
    var pieces = 1

    @note("body / fuselage / hull / tube / stage / cylinder")
    solid body { todo }
    @note("nose / nose cone / cone / tip")
    solid nose { todo }
    @note("engine / nozzle / thruster / exhaust / flame / booster")
    solid engine { todo }
    param fin_count = 2 in 1..8
    for i in 0..<fin_count {
        @note("fin / wing")
        solid fin[i] { todo }
    }
    param window_count = 1 in 0..12
    for i in 0..<window_count {
        @note("window / porthole / port")
        solid window[i] { todo }
    }

    assert nose.center_y >= body.center_y + 0.3 * body.height, "the nose is on top"
    assert clearance(nose, body) <= 0.02 * whole.height, "the nose sits on the body"
    assert nose.width <= 1.1 * body.width, "the nose is no wider than the body"
    assert engine.center_y <= body.center_y, "the engine is at the bottom"
    for f in fin { assert f.center_y <= body.center_y, "the fins are on the lower half" }
    for w in window { assert overlapping(w, body), "the windows are in the body" }
    assert body.height >= 1.5 * body.width, "the body is slim"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert whole.height >= 1.4 * whole.width, "it is much taller than wide"
    assert width_at_top <= 0.6 * width_at_middle, "it is pointed"
    assert fields >= 4, "four fields or more are seen"
}
