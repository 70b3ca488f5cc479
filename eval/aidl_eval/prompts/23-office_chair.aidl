/// office chair
assembly office_chair {
    solid whole { todo }
    var alike = 1
    var fields = 1
    var width_at_bottom = 1
    var width_at_quarter = 1
    var pieces = 1

    @note("seat / cushion, pan")
    solid seat { todo }
    @note("backrest / back / back rest")
    solid back { todo }
    @note("lift / column / gas lift / cylinder / stem / post / piston / pole")
    solid lift { todo }
    param castor_count = 3 in 1..20
    for i in 0..<castor_count {
        @note("castor / caster / wheel / roller")
        solid castor[i] { todo }
    }

    assert back.center_y >= seat.center_y, "the backrest is above the seat"
    assert clearance(lift, seat) <= 0.12 * whole.height, "the column carries the seat"
    assert seat.bottom >= lift.center_y, "the seat is on top of the column"
    assert len(castor) >= 2, "it rolls on several castors"
    for c in castor { assert c.center_y <= lift.center_y, "the castors are at the bottom" }
    assert lift.width <= 0.5 * seat.width, "the column is slim"
    assert min([c.bottom for c in castor]) <= whole.bottom + 0.05 * whole.height, "it stands on its castors"

    // of any language's drawing
    assert pieces <= 1, "the parts hold together"
    assert whole.height >= whole.width, "it is taller than wide"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 5, "five fields or more are seen"
    assert width_at_bottom >= 0.35, "it stands broadly"
    assert width_at_quarter <= 0.7, "it is slim above its foot"
}
