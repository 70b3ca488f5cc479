/// bicycle
assembly bicycle {
    var pieces = 1
    var rounds = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert rounds >= 2, "two round things or more are of one size"
    assert width >= 1.2 * height and width <= 2.6 * height, "it is longer than high, by less than 2.6"
    assert fullness <= 0.6, "one sees through it"
}
