/// chess rook
assembly chess_rook {
    solid whole { todo }
    var width_at_bottom = 1
    var width_at_middle = 1
    var pieces = 1
    var symmetry = 1
    var battlements = 1

    param base_count = 1 in 0..9
    for i in 0..<base_count {
        @note("base, foot / plinth / pedestal")
        solid base[i] { todo }
    }
    param top_count = 1 in 0..20
    for i in 0..<top_count {
        @note("crown, head, battlement / parapet / crenellation / merlon, turret, top")
        solid top[i] { todo }
    }

    assert battlements in 2..9, "the top has merlons with gaps between them"
    assert whole.height >= 1.1 * whole.width, "it is taller than wide"
    assert symmetry >= 0.9, "left and right are alike"
    for b in base {
        assert b.bottom <= whole.bottom + 0.1 * whole.height, "the base is at the bottom"
        assert b.width <= whole.width and abs(b.center_x - whole.center_x) <= 0.05 * whole.width,
            "the base is in the middle"
    }
    for t in top { assert t.center_y >= whole.center_y, "the battlements are at the top" }
    assert pieces <= 1, "the parts stand on each other"

    // of any language's drawing
    assert width_at_middle <= 0.95 * width_at_bottom, "it stands on a broad foot"
}
