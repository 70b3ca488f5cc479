/// office chair
assembly office_chair {
    var pieces = 1
    var alike = 1
    var fields = 1
    var width_at_bottom = 1
    var width_at_quarter = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert height >= width, "it is taller than wide"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 5, "five fields or more are seen"
    assert width_at_bottom >= 0.35, "it stands broadly"
    assert width_at_quarter <= 0.7, "it is slim above its foot"
}
