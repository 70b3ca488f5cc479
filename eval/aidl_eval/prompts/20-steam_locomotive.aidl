/// steam locomotive
assembly steam_locomotive {
    solid whole { todo }
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var pieces = 1

    @note("boiler / drum / barrel, body")
    solid boiler { todo }
    @note("cab / cabin / driver cab")
    solid cab { todo }
    @note("chimney / smokestack / stack / funnel / smoke stack")
    solid chimney { todo }
    param wheel_count = 4 in 1..60
    for i in 0..<wheel_count {
        @note("wheel, driver / driving wheel, tyre / tire; not steering wheel")
        solid wheel[i] { todo }
    }

    assert len(wheel) >= 2, "there are several wheels"
    for w in wheel { assert abs(w.width - w.height) <= 0.05 * w.width, "the wheels are round" }
    for w in wheel { assert w.bottom <= boiler.bottom, "the wheels reach below the boiler" }
    assert chimney.center_y >= boiler.center_y, "the chimney stands on top"
    assert chimney.width <= 0.5 * boiler.width, "the chimney is narrow beside the boiler"
    assert clearance(cab, boiler) <= 0.06 * whole.width, "the cab is at the boiler"
    assert boiler.width >= 1.3 * boiler.height, "the boiler is long"
    assert (cab.center_x - boiler.center_x) * (chimney.center_x - boiler.center_x) <= 0, "cab and chimney are at opposite ends"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.width >= 1.2 * whole.height, "it is longer than high"
    assert rounds >= 2, "two round things or more are of one size"
    assert fields >= 8, "eight fields or more are seen"
    assert symmetry <= 0.98, "its ends differ"
}
