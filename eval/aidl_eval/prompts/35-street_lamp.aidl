/// street lamp
assembly street_lamp {
    solid whole { todo }
    var fields = 1
    var fullness = 1
    var width_at_middle = 1
    var pieces = 1

    @note("post / pole / column / mast / stem / shaft")
    solid post { todo }
    @note("base / foot / plinth / pedestal")
    solid base { todo }
    param light_count = 1 in 1..8
    for i in 0..<light_count {
        @note("lantern / lamp / light / head / luminaire / globe / glass / bulb / shade")
        solid light[i] { todo }
    }

    assert post.height >= 3 * post.width, "the post is tall and slim"
    assert base.bottom <= post.bottom + 0.05 * post.height, "the base is at the bottom"
    assert base.width >= post.width, "the base is broader than the post"
    for l in light { assert l.center_y >= post.center_y, "the light is at the top" }
    for l in light { assert l.height <= 0.6 * whole.height, "the light is smaller than the post" }
    assert clearance(base, post) <= 0.02 * whole.height, "the post stands on its base"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.height >= 1.6 * whole.width, "it is much taller than wide"
    assert width_at_middle <= 0.5, "it is slim in the middle"
    assert fullness <= 0.6, "it is slim"
    assert fields >= 3, "three fields or more are seen"
}
