/// house with a chimney
assembly house {
    var pieces = 1
    var symmetry = 1
    var fullness = 1
    var width_at_bottom = 1
    var width_at_quarter = 1
    var width_at_top = 1

    assert pieces <= 1, "the parts hold together"
    assert width_at_top <= 0.6 * width_at_quarter, "it narrows at the top"
    assert width_at_bottom >= 0.5, "it stands on broad walls"
    assert fullness <= 0.95, "the silhouette is no mere rectangle"
    assert symmetry >= 0.75, "the silhouette is nearly the same on both sides"
}
