/// barbell
assembly barbell {
    var pieces = 1
    var symmetry = 1
    var alike = 1
    var fields = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert width >= 2 * height, "it is much wider than tall"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 5, "five fields or more are seen"
}
