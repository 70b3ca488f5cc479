/// house with a chimney
assembly house {
    solid whole { todo }
    var symmetry = 1
    var fullness = 1
    var width_at_quarter = 1
    var width_at_top = 1
    var pieces = 1

    @note("wall, body, building / facade, house")
    solid wall { todo }
    @note("roof, gable")
    solid roof { todo }
    @note("chimney / chimney stack / smokestack / smoke stack, stack / flue")
    solid chimney { todo }
    @note("door, doorway / door hole / door opening, entrance")
    solid door { todo }
    param window_count = 2 in 0..60
    for i in 0..<window_count {
        @note("window, pane")
        solid window[i] { todo }
    }

    assert roof.center_y >= wall.center_y and roof.top >= wall.top,
        "the roof is on top of the walls"
    assert roof.width >= 0.95 * wall.width, "the roof covers the walls"
    assert clearance(roof, wall) <= 0.08 * whole.height, "the roof lies on the walls"
    assert chimney.left >= roof.left and chimney.right <= roof.right,
        "the chimney is over the roof, not beside it"
    assert clearance(chimney, roof) <= 0.01 * whole.height, "the chimney stands on the roof"
    assert chimney.top >= roof.center_y and chimney.width <= 0.35 * roof.width,
        "the chimney rises slim out of the roof"
    assert inside(door, wall) and door.bottom <= wall.bottom + 0.1 * wall.height,
        "the door is at the foot of the wall"
    for w in window {
        assert inside(w, whole) and (inside(w, door) or no_overlap(w, door)),
            "the windows are in the house and clear of the door"
    }
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert width_at_top <= 0.6 * width_at_quarter, "it narrows at the top"
    assert fullness <= 0.95, "the silhouette is no mere rectangle"
    assert symmetry >= 0.75, "the silhouette is nearly the same on both sides"
}
