/// old-school telephone
assembly telephone {
    var pieces = 1
    var symmetry = 1
    var rounds = 1

    assert pieces <= 1, "the parts hold together"
    assert rounds >= 8, "eight round things or more are of one size"
    assert symmetry >= 0.7, "the silhouette is nearly the same on both sides"
}
