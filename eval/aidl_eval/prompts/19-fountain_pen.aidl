/// fountain pen
assembly fountain_pen {
    var pieces = 1
    var fields = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 2, "no more than a pen and its cap lie apart"
    assert max(width, height) >= 1.8 * min(width, height), "it is long and slim"
    assert fields >= 5, "five fields or more are seen"
    assert fullness <= 0.9, "the silhouette is no mere rectangle"
}
