/// film camera
assembly film_camera {
    solid whole { todo }
    var rounds = 1
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("body, case / housing / box / chassis")
    solid body { todo }
    @note("lens, objective / lens barrel, barrel; not lens cap, viewfinder lens")
    solid lens { todo }
    @note("viewfinder / finder / prism / view finder, window")
    solid viewfinder { todo }
    @note("shutter button / shutter release / release / shutter, button, dial / knob")
    solid shutter { todo }

    assert body.width >= 1.1 * body.height, "the body is wider than tall"
    assert abs(lens.width - lens.height) <= 0.1 * lens.width, "the lens is round"
    assert lens.width >= 0.25 * body.height, "the lens is large"
    assert overlapping(lens, body), "the lens is on the body"
    assert viewfinder.center_y >= lens.center_y, "the viewfinder is above the lens"
    assert shutter.center_y >= body.center_y, "the shutter button is at the top"
    assert area(body) >= area(shutter) * 5, "the body is much larger than the button"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.width >= whole.height, "it is wider than tall"
    assert rounds >= 1, "something is round"
    assert fields >= 5, "five fields or more are seen"
    assert fullness >= 0.6, "it is mostly material"
}
