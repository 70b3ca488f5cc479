/// street lamp
assembly street_lamp {
    var pieces = 1
    var fields = 1
    var fullness = 1
    var width_at_middle = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert height >= 1.6 * width, "it is much taller than wide"
    assert width_at_middle <= 0.5, "it is slim in the middle"
    assert fullness <= 0.6, "it is slim"
    assert fields >= 3, "three fields or more are seen"
}
