/// tractor
assembly tractor {
    solid whole { todo }
    var rounds = 1
    var fields = 1
    var pieces = 1

    param wheel_count = 2 in 1..20
    for i in 0..<wheel_count {
        @note("wheel, tyre / tire, rim; not steering wheel")
        solid wheel[i] { todo }
    }
    @note("body, chassis, hood / bonnet, engine, frame")
    solid body { todo }
    @note("cab / cabin, canopy / cockpit, seat")
    solid cab { todo }

    assert len(wheel) == 2, "there are two wheels to be seen"
    for w in wheel {
        assert abs(w.width - w.height) <= 0.05 * w.width, "the wheels are round"
        assert clearance(w, body) <= 0.05 * whole.width, "the wheels are at the body"
        assert w.bottom <= body.bottom, "the body is off the ground"
    }
    assert max([w.width for w in wheel]) >= 1.15 * min([w.width for w in wheel]),
        "one wheel is larger"
    assert max([w.bottom for w in wheel]) - min([w.bottom for w in wheel]) <= 0.02 * whole.height,
        "the wheels stand on one level"
    assert cab.top >= body.top and cab.center_y >= body.center_y, "the cab rises over the body"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert rounds >= 1, "something is round"
    assert fields >= 5, "five fields or more are seen"
}
