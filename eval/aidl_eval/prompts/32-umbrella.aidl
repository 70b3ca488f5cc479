/// umbrella
assembly umbrella {
    var pieces = 1
    var fields = 1
    var fullness = 1
    var width_at_quarter = 1
    var width_at_three_quarters = 1

    assert pieces <= 1, "the parts hold together"
    assert width_at_quarter <= 0.5, "it is slim below"
    assert width_at_three_quarters >= 0.4, "it is wide above"
    assert fullness <= 0.75, "it is mostly air"
    assert fields >= 3, "three fields or more are seen"
}
