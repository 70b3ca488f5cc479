/// cabinet with drawers
assembly cabinet {
    var alike = 1
    var fields = 1
    var fullness = 1

    assert fullness >= 0.7, "it is mostly material"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 3, "three fields or more are seen"
}
