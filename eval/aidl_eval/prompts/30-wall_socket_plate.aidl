/// wall socket plate
assembly wall_socket_plate {
    var pieces = 1
    var symmetry = 1
    var alike = 1
    var fields = 1
    var fullness = 1

    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert alike >= 2, "two outlines or more are alike"
    assert fullness >= 0.6, "it is mostly material"
    assert fields >= 4, "four fields or more are seen"
}
