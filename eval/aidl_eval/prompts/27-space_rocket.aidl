/// space rocket
assembly space_rocket {
    var pieces = 1
    var symmetry = 1
    var fields = 1
    var width_at_middle = 1
    var width_at_top = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert height >= 1.4 * width, "it is much taller than wide"
    assert width_at_top <= 0.6 * width_at_middle, "it is pointed"
    assert fields >= 4, "four fields or more are seen"
}
