/// barbell
assembly barbell {
    solid whole { todo }
    var symmetry = 1
    var alike = 1
    var fields = 1
    var pieces = 1

    @note("bar / shaft / rod / handle")
    solid bar { todo }
    param plate_count = 2 in 1..40
    for i in 0..<plate_count {
        @note("plate / disc / disk / weight")
        solid plate[i] { todo }
    }
    param collar_count = 2 in 0..8
    for i in 0..<collar_count {
        @note("collar / clip / clamp / lock")
        solid collar[i] { todo }
    }

    assert bar.width >= 8 * bar.height, "the bar is long and slim"
    assert len(plate) >= 2, "there are plates"
    for p in plate { assert abs(p.center_y - bar.center_y) <= 0.05 * p.height, "the plates sit on the bar" }
    for p in plate { assert p.height >= 2 * bar.height, "the plates are larger than the bar" }
    for c in collar { assert abs(c.center_y - bar.center_y) <= 0.6 * c.height, "the collars sit on the bar" }
    for p in plate { assert p.left >= bar.left - 0.05 * bar.width and p.right <= bar.right + 0.05 * bar.width, "the plates are along the bar" }

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert symmetry >= 0.9, "left and right are alike"
    assert whole.width >= 2 * whole.height, "it is much wider than tall"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 5, "five fields or more are seen"
}
