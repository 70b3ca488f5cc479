/// game controller
assembly game_controller {
    var pieces = 1
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert rounds >= 2, "two round things or more are of one size"
    assert symmetry >= 0.85, "the silhouette is nearly the same on both sides"
    assert width >= 1.1 * height, "it is wider than tall"
    assert fields >= 6, "six fields or more are seen"
}
