/// lighthouse
assembly lighthouse {
    solid whole { todo }
    var fields = 1
    var width_at_bottom = 1
    var width_at_three_quarters = 1
    var pieces = 1
    var symmetry = 1

    @note(
        "tower, shaft, column / trunk, wall / body; of band, stripe, section, segment, storey, tier"
    )
    solid tower { todo }
    @note(
        "lantern / lantern room / lantern house, lamp room / light room / lamp house, lamp, light, glass, beacon"
    )
    solid lantern { todo }
    @note("roof, dome / cupola / canopy, cap / cone")
    solid roof { todo }

    assert tower.height >= 1.2 * tower.width, "the tower is taller than wide"
    assert lantern.center_y >= tower.bottom + 0.75 * tower.height,
        "the lantern is at the top of the tower"
    assert roof.center_y >= lantern.center_y, "the roof is above the lantern"
    assert lantern.width <= tower.width, "the lantern is no wider than the tower"
    assert abs(lantern.center_x - tower.center_x) <= 0.05 * tower.width,
        "the lantern is over the middle of the tower"
    assert abs(roof.center_x - tower.center_x) <= 0.05 * tower.width,
        "the roof is over the middle of the tower"
    assert symmetry >= 0.8, "left and right are alike"
    assert pieces <= 1, "the parts stand on each other"

    // of any language's drawing
    assert width_at_three_quarters <= 0.8 * width_at_bottom, "it narrows upwards"
    assert whole.height >= 1.1 * whole.width, "it is taller than wide"
    assert fields >= 4, "four fields or more are seen"
}
