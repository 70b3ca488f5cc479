/// umbrella
assembly umbrella {
    solid whole { todo }
    var fields = 1
    var fullness = 1
    var width_at_quarter = 1
    var width_at_three_quarters = 1
    var pieces = 1

    @note("canopy / cover / cloth / fabric / dome / shade, panel / segment")
    solid canopy { todo }
    @note("shaft / pole / rod / stick / stem")
    solid shaft { todo }
    @note("handle / grip / hook / crook")
    solid handle { todo }

    assert canopy.center_y >= shaft.center_y, "the canopy is at the top"
    assert canopy.width >= 4 * shaft.width, "the canopy is wide"
    assert abs(canopy.center_x - shaft.center_x) <= 0.1 * canopy.width, "the shaft is in the middle"
    assert clearance(handle, shaft) <= 0.02 * whole.height, "the handle is joined to the shaft"
    assert handle.center_y <= shaft.center_y, "the handle is at the bottom"
    assert handle.width <= 0.6 * canopy.width, "the handle is small"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert width_at_quarter <= 0.5, "it is slim below"
    assert width_at_three_quarters >= 0.4, "it is wide above"
    assert fullness <= 0.75, "it is mostly air"
    assert fields >= 3, "three fields or more are seen"
}
