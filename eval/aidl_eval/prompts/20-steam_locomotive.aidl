/// steam locomotive
assembly steam_locomotive {
    var pieces = 1
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert width >= 1.2 * height, "it is longer than high"
    assert rounds >= 2, "two round things or more are of one size"
    assert fields >= 8, "eight fields or more are seen"
    assert symmetry <= 0.98, "its ends differ"
}
