/// floppy disk
assembly floppy_disk {
    solid whole { todo }
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("shell / case / casing / body / housing")
    solid shell { todo }
    @note("shutter / slider / metal")
    solid shutter { todo }
    @note("label / sticker / paper")
    solid label { todo }

    assert abs(shell.width - shell.height) <= 0.15 * shell.width, "the case is nearly square"
    assert shutter.width >= 0.3 * shell.width and shutter.width <= 0.8 * shell.width, "the shutter is about half as wide as the case"
    assert overlapping(shutter, shell) or inside(shutter, shell), "the shutter is on the case"
    assert (label.center_y - shell.center_y) * (shutter.center_y - shell.center_y) <= 0, "label and shutter are at opposite ends"
    assert label.width >= 0.5 * shell.width, "the label is large"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.width <= 1.15 * whole.height and whole.height <= 1.15 * whole.width, "it is nearly square"
    assert fullness >= 0.8, "it is mostly material"
    assert fields >= 4, "four fields or more are seen"
}
