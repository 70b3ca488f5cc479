/// bicycle
assembly bicycle {
    solid whole { todo }
    var rounds = 1
    var fullness = 1
    var pieces = 1

    param wheel_count = 2 in 1..20
    for i in 0..<wheel_count {
        @note("wheel, tyre / tire, rim; not steering wheel, chain wheel, gear wheel")
        solid wheel[i] { todo }
    }
    @note("frame, chassis, main triangle; of tube, stay, fork")
    solid frame { todo }
    @note("saddle / seat")
    solid saddle { todo }
    @note(
        "handlebar / handle bar / steering bar, bar, handle, steering, stem, grip; not cross bar, top bar"
    )
    solid handlebar { todo }

    assert len(wheel) == 2, "there are two wheels"
    for w in wheel { assert abs(w.width - w.height) <= 0.05 * w.width, "the wheels are round" }
    assert abs(wheel[0].width - wheel[-1].width) <= 0.1 * wheel[0].width,
        "the wheels are of like size"
    assert abs(wheel[0].bottom - wheel[-1].bottom) <= 0.02 * whole.height,
        "the wheels stand on one level"
    assert abs(wheel[0].center_x - wheel[-1].center_x) >= 0.5 * (wheel[0].width + wheel[-1].width),
        "the wheels are clear of each other"
    assert saddle.bottom >= wheel[0].center_y, "the saddle is above the hubs"
    assert handlebar.center_y >= wheel[0].center_y, "the handlebar is above the hubs"
    assert saddle.center_x >= min([w.center_x for w in wheel]) and saddle.center_x <= max(
        [w.center_x for w in wheel]
    ),
        "the saddle is between the hubs"
    for w in wheel { assert overlapping(frame, w), "the frame reaches both wheels" }
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert rounds >= 2, "two round things or more are of one size"
    assert whole.width >= 1.2 * whole.height and whole.width <= 2.6 * whole.height, "it is longer than high, by less than 2.6"
    assert fullness <= 0.6, "one sees through it"
}
