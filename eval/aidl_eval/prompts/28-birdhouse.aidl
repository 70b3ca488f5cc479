/// birdhouse
assembly birdhouse {
    solid whole { todo }
    var symmetry = 1
    var rounds = 1
    var fields = 1
    var width_at_three_quarters = 1
    var width_at_top = 1
    var pieces = 1

    @note("box / house / body / front, wall / panel")
    solid box { todo }
    @note("roof; of shingle, slope, pitch")
    solid roof { todo }
    @note("entrance / entry / hole / opening / door")
    solid entrance { todo }
    @note("perch / peg / dowel / rod")
    solid perch { todo }

    assert roof.center_y >= box.center_y, "the roof is on top"
    assert roof.width >= 0.9 * box.width, "the roof covers the box"
    assert clearance(roof, box) <= 0.02 * whole.height, "the roof lies on the box"
    assert inside(entrance, box), "the entrance is in the front"
    assert abs(entrance.width - entrance.height) <= 0.1 * entrance.width, "the entrance is round"
    assert perch.top <= entrance.center_y, "the perch is below the entrance"
    assert overlapping(perch, box), "the perch is at the front"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert rounds >= 1, "something is round"
    assert symmetry >= 0.85, "left and right are alike"
    assert width_at_top <= 0.8 * width_at_three_quarters, "it narrows at the top"
    assert fields >= 3, "three fields or more are seen"
}
