/// old-school telephone
assembly telephone {
    solid whole { todo }
    var symmetry = 1
    var rounds = 1
    var pieces = 1

    @note("base, body, housing / case / casing / cabinet / chassis / box, stand")
    solid base { todo }
    @note(
        "receiver / handset / hand set, horn, phone; of handle, grip, bar, earpiece, mouthpiece, ear piece, mouth piece, ear, cup"
    )
    solid receiver { todo }
    @note(
        "dial, rotary dial, dial plate / dial disc / dial disk / dial wheel, dial ring, rotary, disc / disk / wheel, keypad"
    )
    solid dial { todo }
    param finger_count = 10 in 1..60
    for i in 0..<finger_count {
        @note("finger / finger hole, dial hole, digit / number / numeral, hole, key / button")
        solid finger[i] { todo }
    }

    assert receiver.center_y >= base.center_y + 0.25 * base.height,
        "the receiver lies on top of the base"
    assert receiver.width >= 1.5 * receiver.height, "the receiver is long and low"
    assert clearance(receiver, base) <= 0.15 * whole.height, "the receiver does not hang in the air"
    assert inside(dial, base), "the dial is on the base"
    assert abs(dial.width - dial.height) <= 0.1 * dial.width, "the dial is as wide as tall"
    assert len(finger) >= 8, "the dial has its finger holes"
    for f in finger { assert inside(f, dial), "the finger holes are in the dial" }
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert rounds >= 8, "eight round things or more are of one size"
    assert symmetry >= 0.7, "the silhouette is nearly the same on both sides"
}
