/// padlock
assembly padlock {
    solid whole { todo }
    var symmetry = 1
    var openings = 1
    var width_at_quarter = 1
    var width_at_three_quarters = 1
    var pieces = 1

    @note("body / case / housing / block, plate")
    solid body { todo }
    @note("shackle / bow / hasp / loop / hoop")
    solid shackle { todo }
    @note("keyhole / key hole / key slot / key way, hole / slot")
    solid keyhole { todo }

    assert shackle.center_y >= body.center_y + 0.25 * body.height, "the shackle is on top"
    assert shackle.width <= body.width * 1.02, "the shackle is no wider than the body"
    assert clearance(shackle, body) <= 0.02 * whole.height, "the shackle is joined to the body"
    assert inside(keyhole, body), "the keyhole is in the body"
    assert area(body) >= 0.7 * area(shackle), "the body is heavy"
    assert abs(keyhole.center_x - body.center_x) <= 0.15 * body.width, "the keyhole is in the middle"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert openings >= 1, "the shackle leaves an opening"
    assert symmetry >= 0.85, "left and right are alike"
    assert width_at_three_quarters <= width_at_quarter * 1.02, "it is broadest below"
    assert whole.height >= whole.width, "it is taller than wide"
}
