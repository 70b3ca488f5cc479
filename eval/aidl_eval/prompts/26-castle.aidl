/// castle
assembly castle {
    solid whole { todo }
    var symmetry = 1
    var alike = 1
    var fields = 1
    var fullness = 1
    var width_at_bottom = 1
    var pieces = 1

    @note("wall / walls / curtain / curtain wall, keep")
    solid wall { todo }
    @note("gate / gateway / door / portcullis / drawbridge / entrance")
    solid gate { todo }
    param tower_count = 2 in 1..12
    for i in 0..<tower_count {
        @note("tower / turret")
        solid tower[i] { todo }
    }

    assert len(tower) >= 2, "there are several towers"
    for t in tower { assert t.height >= t.width, "the towers stand upright" }
    for t in tower { assert t.top >= wall.bottom + 0.6 * wall.height, "the towers are about as high as the walls, or higher" }
    assert gate.bottom <= whole.bottom + 0.2 * whole.height, "the gate is at the ground"
    assert gate.height <= 0.6 * whole.height, "the gate is lower than the castle"
    assert abs(tower[0].bottom - wall.bottom) <= 0.15 * whole.height, "towers and walls stand on one ground"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 6, "six fields or more are seen"
    assert symmetry >= 0.8, "left and right are alike"
    assert fullness <= 0.95, "the silhouette is no mere rectangle"
    assert width_at_bottom >= 0.7, "it stands broadly"
}
