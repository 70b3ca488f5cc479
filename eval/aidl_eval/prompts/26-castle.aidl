/// castle
assembly castle {
    var pieces = 1
    var symmetry = 1
    var alike = 1
    var fields = 1
    var fullness = 1
    var width_at_bottom = 1

    assert pieces <= 1, "the parts hold together"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 6, "six fields or more are seen"
    assert symmetry >= 0.8, "left and right are alike"
    assert fullness <= 0.95, "the silhouette is no mere rectangle"
    assert width_at_bottom >= 0.7, "it stands broadly"
}
