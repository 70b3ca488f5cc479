/// floppy disk
assembly floppy_disk {
    var pieces = 1
    var fields = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert width <= 1.15 * height and height <= 1.15 * width, "it is nearly square"
    assert fullness >= 0.8, "it is mostly material"
    assert fields >= 4, "four fields or more are seen"
}
