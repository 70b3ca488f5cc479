/// claw hammer
assembly claw_hammer {
    solid whole { todo }
    var symmetry = 1
    var fullness = 1
    var width_at_middle = 1
    var pieces = 1

    @note("handle / shaft / haft / grip")
    solid handle { todo }
    @note("head; of face, claw, poll, neck, cheek, body")
    solid head { todo }
    @note("claw / claws / prong / fork / tine")
    solid claw { todo }
    @note("face / striking face / poll / strike, bell")
    solid face { todo }

    assert max(handle.width, handle.height) >= 3 * min(handle.width, handle.height), "the handle is long and slim"
    assert clearance(head, handle) <= 0.02 * max(whole.width, whole.height), "the head sits on the handle"
    assert (claw.center_x - handle.center_x) * (face.center_x - handle.center_x) <= 0, "claw and face are on opposite sides"
    assert claw.center_y >= handle.center_y, "the claw is at the top"
    assert max(whole.width, whole.height) >= 1.2 * max(head.width, head.height), "the handle reaches far beyond the head"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.height >= 1.2 * whole.width, "it is taller than wide"
    assert width_at_middle <= 0.5, "it is slim in the middle"
    assert fullness <= 0.6, "it is slim"
    assert symmetry <= 0.97, "its two sides differ"
}
