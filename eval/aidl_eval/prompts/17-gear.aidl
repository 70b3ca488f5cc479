/// gear with mounting holes
assembly gear {
    var pieces = 1
    var openings = 1
    var teeth = 1
    var rounds = 1
    var width = 1
    var height = 1

    assert teeth >= 8, "there are at least eight teeth"
    assert openings >= 2, "at least two holes go through it, clear of the rim"
    assert abs(width - height) <= 0.1 * width, "it is round"
    assert pieces == 1, "it is one piece"
    assert width <= 1.1 * height and height <= 1.1 * width, "it is as wide as tall"
    assert rounds >= 3, "three round holes or more are of one size"
}
