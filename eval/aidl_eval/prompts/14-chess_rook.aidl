/// chess rook
assembly chess_rook {
    var pieces = 1
    var symmetry = 1
    var battlements = 1
    var width_at_bottom = 1
    var width_at_middle = 1
    var width = 1
    var height = 1

    assert battlements in 2..9, "the top has merlons with gaps between them"
    assert height >= 1.1 * width, "it is taller than wide"
    assert symmetry >= 0.9, "left and right are alike"
    assert pieces <= 1, "the parts stand on each other"
    assert width_at_middle <= 0.95 * width_at_bottom, "it stands on a broad foot"
}
