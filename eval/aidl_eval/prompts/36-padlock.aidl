/// padlock
assembly padlock {
    var pieces = 1
    var symmetry = 1
    var openings = 1
    var width_at_quarter = 1
    var width_at_three_quarters = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert openings >= 1, "the shackle leaves an opening"
    assert symmetry >= 0.85, "left and right are alike"
    assert width_at_three_quarters <= width_at_quarter * 1.02, "it is broadest below"
    assert height >= width, "it is taller than wide"
}
