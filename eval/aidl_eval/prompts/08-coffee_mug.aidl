/// coffee mug
assembly coffee_mug {
    solid whole { todo }
    var symmetry = 1
    var fullness = 1
    var pieces = 1
    var openings = 1

    @note("cup / mug, body / vessel, wall / cylinder / container")
    solid cup { todo }
    @note("handle, grip, ear / loop")
    solid handle { todo }

    assert cup.height >= 0.6 * cup.width and cup.height <= 2.5 * cup.width,
        "the mug has the proportions of one"
    assert clearance(handle, cup) <= 0.005 * whole.width, "the handle is joined to the mug"
    assert handle.right >= cup.right + 0.1 * cup.width or handle.left <= cup.left - 0.1 * cup.width,
        "the handle stands out at a side"
    assert handle.top <= cup.top + 0.02 * cup.height and handle.bottom >= cup.bottom - 0.02 * cup.height,
        "the handle is between rim and bottom"
    assert handle.width <= cup.width, "the handle is narrower than the mug"
    assert openings >= 1, "the handle leaves room for fingers"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert openings >= 1, "the handle leaves an opening"
    assert fullness >= 0.5, "it is mostly material"
    assert symmetry <= 0.98, "the handle is on one side"
}
