/// acoustic guitar
assembly acoustic_guitar {
    solid whole { todo }
    var rounds = 1
    var fields = 1
    var pieces = 1

    @note("body, soundbox / sound box, top; of bout, waist")
    solid body { todo }
    @note("neck, fretboard / fingerboard")
    solid neck { todo }
    @note("head / headstock / peghead / head stock")
    solid head { todo }
    @note("sound hole / soundhole, hole, rosette")
    solid sound_hole { todo }

    assert max(neck.width, neck.height) >= 3 * min(neck.width, neck.height),
        "the neck is long and slim"
    assert clearance(neck, body) <= 0.03 * max(whole.width, whole.height),
        "the neck is joined to the body"
    assert clearance(head, neck) <= 0.03 * max(whole.width, whole.height),
        "the head is joined to the neck"
    assert hypot(head.center_x - body.center_x, head.center_y - body.center_y) >= hypot(
        neck.center_x - body.center_x, neck.center_y - body.center_y
    ),
        "the head is at the far end of the neck"
    assert body.width * body.height >= 2 * head.width * head.height,
        "the body is larger than the head"
    assert inside(sound_hole, body), "the sound hole is in the body"
    assert abs(sound_hole.width - sound_hole.height) <= 0.1 * sound_hole.width,
        "the sound hole is round"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert max(whole.width, whole.height) >= 1.8 * min(whole.width, whole.height), "it is long and slim"
    assert rounds >= 1, "something is round"
    assert fields >= 3, "three fields or more are seen"
}
