/// sunglasses
assembly sunglasses {
    solid whole { todo }
    var symmetry = 1
    var alike = 1
    var fields = 1
    var pieces = 1

    @note("frame / front / rim")
    solid frame { todo }
    @note("bridge / nose bridge, front, frame")
    solid bridge { todo }
    param lens_count = 2 in 1..4
    for i in 0..<lens_count {
        @note("lens / lenses / glass")
        solid lens[i] { todo }
    }
    param temple_count = 2 in 0..6
    for i in 0..<temple_count {
        @note("temple / arm / temples / earpiece")
        solid temple[i] { todo }
    }

    assert len(lens) == 2 or len(lens) == 1, "there are two lenses, or one pair"
    for l in lens { assert overlapping(l, frame), "the lenses are in the frame" }
    assert frame.width >= 1.8 * frame.height, "the frame is wide"
    for l in lens { assert abs(l.center_y - frame.center_y) <= 0.35 * frame.height, "the lenses are level with the frame" }
    assert overlapping(bridge, frame), "the bridge is in the frame"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert alike >= 2, "two outlines or more are alike"
    assert whole.width >= 1.5 * whole.height, "it is much wider than tall"
    assert fields >= 3, "three fields or more are seen"
}
