/// windmill
assembly windmill {
    solid whole { todo }
    var symmetry = 1
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("tower / body / mill / building / trunk")
    solid tower { todo }
    @note("cap / dome / roof / head")
    solid cap { todo }
    param sail_count = 4 in 1..12
    for i in 0..<sail_count {
        @note("sail / blade / vane, wing / sweep")
        solid sail[i] { todo }
    }

    assert len(sail) == 4 or len(sail) == 3 or len(sail) >= 5, "there are three sails or more"
    assert cap.bottom >= tower.center_y, "the cap is on top of the tower"
    assert clearance(cap, tower) <= 0.03 * whole.height, "the cap lies on the tower"
    assert max([s.top for s in sail]) >= tower.top, "the sails reach above the tower"
    assert max([s.width for s in sail]) >= 0.3 * tower.width, "the sails are large"
    assert tower.height >= 0.8 * tower.width, "the tower stands upright"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert fields >= 6, "six fields or more are seen"
    assert symmetry >= 0.5, "the silhouette is roughly the same on both sides"
    assert fullness <= 0.75, "one sees between the sails"
    assert whole.height >= 0.7 * whole.width, "it is tall"
}
