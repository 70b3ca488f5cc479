/// toaster
assembly toaster {
    solid whole { todo }
    var alike = 1
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("body / case / housing / shell / chassis")
    solid body { todo }
    @note("lever / handle / slider / knob / plunger")
    solid lever { todo }
    param foot_count = 2 in 1..6
    for i in 0..<foot_count {
        @note("foot / feet / leg / base")
        solid foot[i] { todo }
    }
    param toast_count = 2 in 1..8
    for i in 0..<toast_count {
        @note("toast / bread / slice, slot")
        solid toast[i] { todo }
    }

    for t in toast { assert t.top >= body.center_y, "the bread is at the top" }
    assert body.width >= 0.9 * body.height, "the body is no tower"
    for f in foot { assert f.bottom <= body.bottom + 0.1 * body.height, "it stands on its feet" }
    assert clearance(lever, body) <= 0.02 * whole.width, "the lever is at the body"
    assert area(lever) <= 0.2 * area(body), "the lever is small"
    for f in foot { assert clearance(f, body) <= 0.02 * whole.height, "the feet are joined to the body" }

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.width >= 0.9 * whole.height, "it is about as wide as tall, or wider"
    assert fullness >= 0.5, "it is mostly material"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 4, "four fields or more are seen"
}
