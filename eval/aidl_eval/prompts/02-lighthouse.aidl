/// lighthouse
assembly lighthouse {
    var pieces = 1
    var symmetry = 1
    var fields = 1
    var width_at_bottom = 1
    var width_at_three_quarters = 1
    var width = 1
    var height = 1

    assert symmetry >= 0.8, "left and right are alike"
    assert pieces <= 1, "the parts stand on each other"
    assert width_at_three_quarters <= 0.8 * width_at_bottom, "it narrows upwards"
    assert height >= 1.1 * width, "it is taller than wide"
    assert fields >= 4, "four fields or more are seen"
}
