/// wall socket plate
assembly wall_socket_plate {
    solid whole { todo }
    var symmetry = 1
    var alike = 1
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("plate / cover / faceplate / frame, body")
    solid plate { todo }
    param slot_count = 2 in 1..40
    for i in 0..<slot_count {
        @note("slot / hole / pin / contact / socket / opening / prong")
        solid slot[i] { todo }
    }
    param screw_count = 1 in 0..12
    for i in 0..<screw_count {
        @note("screw / screw hole / mount hole / mounting hole / bolt")
        solid screw[i] { todo }
    }

    assert len(slot) >= 2, "there are holes for the pins"
    for s in slot { assert inside(s, plate), "the holes are in the plate" }
    for s in screw { assert inside(s, plate), "the screws are in the plate" }
    for s in slot { assert s.width * s.height <= 0.7 * plate.width * plate.height, "the holes are smaller than the plate" }
    assert plate.width <= 2 * plate.height and plate.height <= 2 * plate.width, "the plate is not long"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert alike >= 2, "two outlines or more are alike"
    assert fullness >= 0.6, "it is mostly material"
    assert fields >= 4, "four fields or more are seen"
}
