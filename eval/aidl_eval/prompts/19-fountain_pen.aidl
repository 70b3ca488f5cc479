/// fountain pen
assembly fountain_pen {
    solid whole { todo }
    var fields = 1
    var fullness = 1
    var pieces = 1

    @note("barrel / body / shaft / tube / holder; not cap barrel")
    solid barrel { todo }
    @note("nib / tip / point / blade")
    solid nib { todo }
    @note("section / grip / grip section, collar / feed")
    solid section { todo }

    assert clearance(nib, section) <= 0.03 * max(whole.width, whole.height), "the nib is joined to the grip"
    assert area(barrel) >= 2 * area(nib), "the barrel is larger than the nib"
    assert max(nib.width, nib.height) <= 0.4 * max(whole.width, whole.height), "the nib is short beside the pen"
    assert min(nib.width, nib.height) <= 1.2 * min(barrel.width, barrel.height), "the nib is no thicker than the barrel"
    assert hypot(nib.center_x - barrel.center_x, nib.center_y - barrel.center_y) >= hypot(section.center_x - barrel.center_x, section.center_y - barrel.center_y), "the nib is at the end, beyond the grip"

    // of any language's drawing
    assert pieces <= 2, "no more than a pen and its cap lie apart"
    assert max(whole.width, whole.height) >= 1.8 * min(whole.width, whole.height), "it is long and slim"
    assert fields >= 5, "five fields or more are seen"
    assert fullness <= 0.9, "the silhouette is no mere rectangle"
}
