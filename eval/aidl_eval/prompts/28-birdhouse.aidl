/// birdhouse
assembly birdhouse {
    var pieces = 1
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var width_at_three_quarters = 1
    var width_at_top = 1

    assert pieces <= 1, "the parts hold together"
    assert rounds >= 1, "something is round"
    assert symmetry >= 0.85, "left and right are alike"
    assert width_at_top <= 0.8 * width_at_three_quarters, "it narrows at the top"
    assert fields >= 3, "three fields or more are seen"
}
