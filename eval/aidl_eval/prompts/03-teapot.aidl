/// teapot
assembly teapot {
    solid whole { todo }
    var fields = 1
    var width_at_middle = 1
    var width_at_top = 1
    var pieces = 1

    @note("pot, body, vessel / belly / bowl, kettle")
    solid pot { todo }
    @note("lid / cover, cap")
    solid lid { todo }
    @note("spout / beak / nozzle")
    solid spout { todo }
    @note("handle / grip, ear / loop; not lid handle, lid grip")
    solid handle { todo }

    assert lid.center_y >= pot.center_y + 0.25 * pot.height, "the lid is on top of the pot"
    assert clearance(lid, pot) <= 0.1 * whole.height, "the lid lies on the pot"
    assert lid.width <= pot.width, "the lid is no wider than the pot"
    assert clearance(spout, pot) <= 0.01 * whole.width, "the spout is joined to the pot"
    assert clearance(handle, pot) <= 0.01 * whole.width, "the handle is joined to the pot"
    assert spout.center_x <= pot.left + 0.3 * pot.width and handle.center_x >= pot.right - 0.3 * pot.width or spout.center_x >= pot.right - 0.3 * pot.width and handle.center_x <= pot.left + 0.3 * pot.width,
        "spout and handle are on opposite sides"
    assert spout.left <= pot.left - 0.05 * pot.width or spout.right >= pot.right + 0.05 * pot.width,
        "the spout reaches out of the pot"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert whole.width >= 1.05 * whole.height, "it is wider than tall"
    assert width_at_top <= 0.6 * width_at_middle, "it is much narrower at the top"
    assert fields >= 3, "three fields or more are seen"
}
