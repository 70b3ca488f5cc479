/// sailing boat
assembly sailing_boat {
    var pieces = 1
    var fields = 1
    var width_at_bottom = 1
    var width_at_quarter = 1
    var width_at_top = 1

    assert pieces <= 1, "the parts hold together"
    assert width_at_top <= 0.4 * max(width_at_bottom, width_at_quarter), "it ends in a narrow top"
    assert fields >= 3, "three fields or more are seen"
}
