/// panelled door with a handle
assembly door {
    var alike = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert height >= 1.5 * width, "it is much taller than wide"
    assert alike >= 2, "two outlines or more are alike"
    assert fullness >= 0.7, "it is mostly material"
}
