/// table lamp
assembly table_lamp {
    var pieces = 1
    var symmetry = 1
    var width_at_bottom = 1
    var width_at_middle = 1
    var width_at_three_quarters = 1

    assert symmetry >= 0.8, "left and right are alike"
    assert pieces <= 1, "the parts hold together"
    assert width_at_middle <= 0.8 * max(width_at_three_quarters, width_at_bottom), "it has a waist"
    assert symmetry >= 0.6, "the silhouette is nearly the same on both sides"
}
