/// acoustic guitar
assembly acoustic_guitar {
    var pieces = 1
    var rounds = 1
    var fields = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert max(width, height) >= 1.8 * min(width, height), "it is long and slim"
    assert rounds >= 1, "something is round"
    assert fields >= 3, "three fields or more are seen"
}
