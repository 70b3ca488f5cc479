/// teapot
assembly teapot {
    var pieces = 1
    var fields = 1
    var width_at_middle = 1
    var width_at_top = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert width >= 1.05 * height, "it is wider than tall"
    assert width_at_top <= 0.6 * width_at_middle, "it is much narrower at the top"
    assert fields >= 3, "three fields or more are seen"
}
