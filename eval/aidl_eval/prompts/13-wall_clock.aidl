/// wall clock
assembly wall_clock {
    solid whole { todo }
    var fields = 1

    @note("face / dial, disc / disk / plate, case / body / frame / rim")
    solid face { todo }
    param hand_count = 2 in 1..9
    for i in 0..<hand_count {
        @note("hand / pointer / needle")
        solid hand[i] { todo }
    }
    param mark_count = 12 in 1..120
    for i in 0..<mark_count {
        @note("mark / marker / tick / hour mark, numeral / number / digit, hour, index")
        solid mark[i] { todo }
    }

    assert abs(face.width - face.height) <= 0.1 * face.width, "the face is as wide as tall"
    assert len(hand) in 2..3, "there are two or three hands"
    for h in hand {
        assert face.center_x in h.left - 0.03 * face.width..h.right + 0.03 * face.width and face.center_y in h.bottom - 0.03 * face.height..h.top + 0.03 * face.height,
            "the hands start at the centre"
        assert inside(h, face), "the hands are within the face"
    }
    assert max([hypot(h.width, h.height) for h in hand]) >= 1.15 * min(
        [hypot(h.width, h.height) for h in hand]
    ),
        "the hands are of different length"
    assert len(mark) >= 4, "the hours are marked"
    for m in mark { assert inside(m, face), "the marks are within the face" }

    // of any language's drawing
    assert whole.width <= 1.3 * whole.height, "it is not much wider than tall"
    assert fields >= 4, "four fields or more are seen"
}
