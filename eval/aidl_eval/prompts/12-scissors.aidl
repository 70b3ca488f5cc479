/// pair of scissors
assembly scissors {
    solid whole { todo }
    var fullness = 1
    var pieces = 1
    var openings = 1

    param blade_count = 2 in 1..9
    for i in 0..<blade_count {
        @note("blade, edge / cutting edge; of half, arm, lever")
        solid blade[i] { todo }
    }
    param handle_count = 2 in 1..9
    for i in 0..<handle_count {
        @note(
            "handle / grip, loop / ring / bow / eye, finger / finger hole / finger ring / finger loop"
        )
        solid handle[i] { todo }
    }
    @note("pivot, screw / rivet / hinge / pin / bolt, pivot hole, joint / bore / axis")
    solid pivot { todo }

    assert len(blade) == 2, "there are two blades"
    assert abs(
        hypot(blade[0].width, blade[0].height) - hypot(blade[-1].width, blade[-1].height)
    ) <= 0.15 * hypot(blade[0].width, blade[0].height),
        "the blades are of like length"
    assert len(handle) == 2, "there are two handles"
    assert abs(
        handle[0].width * handle[0].height - handle[-1].width * handle[-1].height
    ) <= 0.4 * handle[0].width * handle[0].height,
        "the handles are of like size"
    for b in blade {
        assert clearance(pivot, b) <= 0.02 * max(whole.width, whole.height),
            "the pivot is in both blades"
    }
    assert openings >= 2, "fingers fit into the handles"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert openings >= 2, "two openings or more are for fingers"
    assert fullness <= 0.7, "it is slim"
}
