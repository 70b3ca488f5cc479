/// wall clock
assembly wall_clock {
    var fields = 1
    var width = 1
    var height = 1

    assert width <= 1.3 * height, "it is not much wider than tall"
    assert fields >= 4, "four fields or more are seen"
}
