/// windmill
assembly windmill {
    var pieces = 1
    var symmetry = 1
    var fields = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert fields >= 6, "six fields or more are seen"
    assert symmetry >= 0.5, "the silhouette is roughly the same on both sides"
    assert fullness <= 0.75, "one sees between the sails"
    assert height >= 0.7 * width, "it is tall"
}
