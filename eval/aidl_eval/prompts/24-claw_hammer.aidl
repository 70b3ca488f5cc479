/// claw hammer
assembly claw_hammer {
    var pieces = 1
    var symmetry = 1
    var fullness = 1
    var width_at_middle = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert height >= 1.2 * width, "it is taller than wide"
    assert width_at_middle <= 0.5, "it is slim in the middle"
    assert fullness <= 0.6, "it is slim"
    assert symmetry <= 0.97, "its two sides differ"
}
