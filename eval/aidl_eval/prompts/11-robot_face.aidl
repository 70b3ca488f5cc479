/// robot face
assembly robot_face {
    var symmetry = 1
    var alike = 1
    var fields = 1

    assert symmetry >= 0.8, "left and right are alike"
    assert symmetry >= 0.85, "the silhouette is nearly the same on both sides"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 4, "four fields or more are seen"
}
