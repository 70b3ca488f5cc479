/// film camera
assembly film_camera {
    var pieces = 1
    var rounds = 1
    var fields = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert width >= height, "it is wider than tall"
    assert rounds >= 1, "something is round"
    assert fields >= 5, "five fields or more are seen"
    assert fullness >= 0.6, "it is mostly material"
}
