/// table lamp
assembly table_lamp {
    solid whole { todo }
    var width_at_bottom = 1
    var width_at_middle = 1
    var width_at_three_quarters = 1
    var pieces = 1
    var symmetry = 1

    @note("base, foot, lamp base, plate")
    solid base { todo }
    @note("stem, pole / column / rod / post, neck, stand / arm / body / shaft")
    solid stem { todo }
    @note("shade / lampshade, screen / hood")
    solid shade { todo }

    assert shade.bottom >= base.top, "the shade is above the base"
    assert base.bottom <= stem.bottom + 0.02 * whole.height, "the base is at the bottom"
    assert stem.width <= 0.6 * shade.width, "the stem is slimmer than the shade"
    assert clearance(stem, base) <= 0.05 * whole.height, "the stem stands on the base"
    assert clearance(stem, shade) <= 0.15 * whole.height, "the stem carries the shade"
    assert abs(shade.center_x - base.center_x) <= 0.1 * whole.width, "the shade is over the base"
    assert symmetry >= 0.8, "left and right are alike"
    assert pieces <= 1, "the parts hold together"

    // of any language's drawing
    assert width_at_middle <= 0.8 * max(width_at_three_quarters, width_at_bottom), "it has a waist"
    assert symmetry >= 0.6, "the silhouette is nearly the same on both sides"
}
