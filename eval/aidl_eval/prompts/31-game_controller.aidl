/// game controller
assembly game_controller {
    solid whole { todo }
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var pieces = 1

    @note("shell / body, case / casing / housing / chassis / grip")
    solid body { todo }
    @note("d-pad / dpad / directional pad / pad / cross")
    solid pad { todo }
    param stick_count = 2 in 0..4
    for i in 0..<stick_count {
        @note("stick / thumbstick / joystick / analog / analog stick")
        solid stick[i] { todo }
    }
    param button_count = 4 in 1..30
    for i in 0..<button_count {
        @note("key / button / face button; not bumper, shoulder, trigger, home, menu")
        solid button[i] { todo }
    }

    assert len(button) >= 2, "there are several buttons"
    assert body.width >= 1.1 * body.height, "the body is wider than tall"
    for b in button { assert overlapping(b, body), "the buttons are on the body" }
    assert pad.center_x <= body.center_x, "the cross is on the left"
    for s in stick { assert overlapping(s, body), "the sticks are on the body" }

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert rounds >= 2, "two round things or more are of one size"
    assert symmetry >= 0.85, "the silhouette is nearly the same on both sides"
    assert whole.width >= 1.1 * whole.height, "it is wider than tall"
    assert fields >= 6, "six fields or more are seen"
}
