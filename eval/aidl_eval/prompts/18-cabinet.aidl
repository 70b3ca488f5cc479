/// cabinet with drawers
assembly cabinet {
    solid whole { todo }
    var alike = 1
    var fields = 1
    var fullness = 1

    @note(
        "cabinet / carcass / carcase / corpus, case / body / chest, frame / outer / shell / box; of side, board, panel, shelf"
    )
    solid cabinet { todo }
    param drawer_count = 3 in 1..24
    for i in 0..<drawer_count {
        @note("drawer, drawer front, front")
        solid drawer[i] { todo }
    }
    param handle_count = 3 in 0..120
    for i in 0..<handle_count {
        @note("handle / knob / pull / grip")
        solid handle[i] { todo }
    }

    param foot_count = 2 in 0..12
    for i in 0..<foot_count {
        @note("foot / leg / feet, plinth / base / kick / toe kick")
        solid foot[i] { todo }
    }

    assert len(drawer) >= 2, "there are several drawers"
    for f in foot {
        assert clearance(f, cabinet) <= 0.02 * whole.height, "the feet carry the cabinet"
    }
    for d in drawer { assert inside(d, cabinet), "the drawers are in the cabinet" }
    for i in 0..<len(drawer) {
        for j in i + 1..<len(drawer) {
            assert no_overlap(drawer[i], drawer[j]), "the drawers do not overlap"
        }
    }
    for d in drawer {
        assert abs(d.width - drawer[0].width) <= 0.6 * drawer[0].width,
            "the drawers are of like width"
    }
    assert sum([d.width * d.height for d in drawer]) >= 0.3 * cabinet.width * cabinet.height,
        "the drawers fill a good part of the front"
    assert len(handle) == 0 or len(handle) >= len(drawer), "each drawer has its handle"
    for h in handle { assert inside(h, cabinet), "the handles are on the front" }

    // of any language's drawing
    assert fullness >= 0.7, "it is mostly material"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 3, "three fields or more are seen"
}
