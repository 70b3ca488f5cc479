/// panelled door with a handle
assembly door {
    solid whole { todo }
    var alike = 1
    var fullness = 1

    @note("leaf / slab, door, door panel, body / board")
    solid door { todo }
    param panel_count = 4 in 1..24
    for i in 0..<panel_count {
        @note("panel, inset / recess / field; not door panel")
        solid panel[i] { todo }
    }
    @note("handle, knob / doorknob / lever, latch")
    solid handle { todo }

    assert door.height in 1.5 * door.width..4 * door.width, "the door has the proportions of one"
    assert len(panel) >= 2, "there are several panels"
    for p in panel { assert inside(p, door), "the panels are in the door" }
    for i in 0..<len(panel) {
        for j in i + 1..<len(panel) {
            assert no_overlap(panel[i], panel[j]), "the panels are apart from each other"
        }
    }
    assert inside(handle, door), "the handle is on the door"
    assert abs(handle.center_x - door.center_x) >= 0.2 * door.width, "the handle is at a side"
    assert handle.center_y in door.bottom + 0.25 * door.height..door.bottom + 0.75 * door.height,
        "the handle is at the height of a hand"
    assert handle.height <= 0.3 * door.height and handle.width <= 0.4 * door.width,
        "the handle is small beside the door"

    // of any language's drawing
    assert whole.height >= 1.5 * whole.width, "it is much taller than wide"
    assert alike >= 2, "two outlines or more are alike"
    assert fullness >= 0.7, "it is mostly material"
}
