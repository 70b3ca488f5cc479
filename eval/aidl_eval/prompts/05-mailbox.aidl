/// mailbox
assembly mailbox {
    solid whole { todo }
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("box / mailbox / letterbox, body, housing / container / case / shell")
    solid box { todo }
    param post_count = 1 in 0..9
    for i in 0..<post_count {
        @note("post, pole / pillar, stand / support, leg, column")
        solid post[i] { todo }
    }
    param flag_count = 1 in 0..9
    for i in 0..<flag_count {
        @note("flag, signal, indicator")
        solid flag[i] { todo }
    }
    param slot_count = 1 in 0..9
    for i in 0..<slot_count {
        @note("slot / door / letter slot, opening / mouth / flap / hatch")
        solid slot[i] { todo }
    }

    assert len(post) + len(flag) + len(slot) >= 1, "there is a post, a flag, or a slot or door"
    for p in post {
        assert box.center_y >= p.center_y, "the box is up on its post"
        assert clearance(p, box) <= 0.05 * whole.height, "the post carries the box"
        assert area(p) <= 0.5 * box.width * p.height, "the post is slimmer than the box"
    }
    for f in flag {
        assert clearance(f, box) <= 0.03 * whole.height, "the flag is fixed to the box"
        assert f.width <= box.width and f.height <= 1.5 * box.height,
            "the flag is smaller than the box"
    }
    for s in slot { assert inside(s, box), "the slot or door is in the box" }
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert fields >= 3, "three fields or more are seen"
    assert fullness <= 0.98, "the silhouette is no mere rectangle"
}
