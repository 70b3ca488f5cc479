/// pair of scissors
assembly scissors {
    var pieces = 1
    var openings = 1
    var fullness = 1

    assert openings >= 2, "fingers fit into the handles"
    assert pieces <= 1, "the parts hold together"
    assert openings >= 2, "two openings or more are for fingers"
    assert fullness <= 0.7, "it is slim"
}
