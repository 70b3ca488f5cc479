/// toaster
assembly toaster {
    var pieces = 1
    var alike = 1
    var fields = 1
    var fullness = 1
    var width = 1
    var height = 1

    assert pieces <= 1, "the parts hold together"
    assert width >= 0.9 * height, "it is about as wide as tall, or wider"
    assert fullness >= 0.5, "it is mostly material"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 4, "four fields or more are seen"
}
