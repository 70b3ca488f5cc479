/// coffee mug
assembly coffee_mug {
    var pieces = 1
    var symmetry = 1
    var openings = 1
    var fullness = 1

    assert openings >= 1, "the handle leaves room for fingers"
    assert pieces <= 1, "the parts hold together"
    assert openings >= 1, "the handle leaves an opening"
    assert fullness >= 0.5, "it is mostly material"
    assert symmetry <= 0.98, "the handle is on one side"
}
