/// sunglasses
assembly sunglasses {
    var pieces = 1
    var symmetry = 1
    var alike = 1
    var fields = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert alike >= 2, "two outlines or more are alike"
    assert width >= 1.5 * height, "it is much wider than tall"
    assert fields >= 3, "three fields or more are seen"
}
