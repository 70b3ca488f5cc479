/// tractor
assembly tractor {
    var pieces = 1
    var rounds = 1
    var fields = 1

    assert pieces <= 1, "the parts hold together"
    assert rounds >= 1, "something is round"
    assert fields >= 5, "five fields or more are seen"
}
