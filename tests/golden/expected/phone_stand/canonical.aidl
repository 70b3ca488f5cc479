/// A stand for a phone, cut from one sheet and put together without glue: two sides, and two bars whose tabs go into
/// slots of the sides.
assembly phone_stand {
    param thickness = 4mm in 3..6  // of the sheet
    param lean = 65deg in 55..75   // of the phone, against the table
    param phone = 13mm in 8..18    // how thick it is, with its case
    param high = 80mm in 65..110   // how far up its back is held
    param span = 50mm in 30..70    // between the two sides
    param play = 0.1mm in 0..0.3   // how much wider a slot is than its tab
    let wall = 7mm                 // the least material around a slot
    let tab = 20mm

    // A way up along the back of the phone, and one forward out of it.
    fn climb(d: length) = polar(d, 180deg - lean)
    fn forth(d: length) = polar(d, 90deg - lean)
    let heel = (0mm, 2 * wall + thickness + 2mm)

    @thickness(thickness)
    @material("birch plywood")
    solid side() {
        let toe = heel + forth(phone)
        let lip = toe + climb(10mm)
        let tip = heel + climb(high)
        let crown = tip - forth(2 * wall + thickness)
        edge = polygon(
            points: [
                fixed((crown.x - 8mm, 0mm)),
                fixed(((toe + forth(8mm)).x, 0mm)),
                fixed(lip + forth(8mm)),
                fixed(lip),
                fixed(toe),
                fixed(heel),
                fixed(tip),
                fixed(crown)
            ]
        )
        hole back {
            slot = rectangle(
                center: fixed(heel + climb(high - wall - tab / 2) - forth(wall + thickness / 2)),
                width: tab + play,
                height: thickness + play,
                angle: 180deg - lean
            )
        }
        hole foot {
            slot = rectangle(
                center: fixed((0mm, wall + thickness / 2)),
                width: tab + play,
                height: thickness + play
            )
        }
    }

    @thickness(thickness)
    @material("birch plywood")
    solid bar() {
        body = rectangle(center: origin, width: span, height: tab + 12)
        tabs = rectangle(center: origin, width: span + 2 * thickness, height: tab)
    }

    @detached
    left = side()
    @detached
    right = side() at (100, 0)
    @detached
    back = bar() at (0, -40)
    @detached
    foot = bar() at (80, -40)

    constrain {
        right.right_of(left, gap: 5)
        right.bottom == left.bottom
        back.below(left, gap: 5)
        back.left == left.left
        foot.right_of(back, gap: 5)
        foot.bottom == back.bottom
    }

    // A phone of 150 mm has its weight over the foot.
    let balance = heel + climb(75mm)
    assert left.edge.corner[0].x <= left.origin.x + balance.x - 5mm, "the stand tips over backwards"
    assert left.back.slot.width == back.tabs.height + play, "the tabs do not fit"
    assert clearance(left.back, left.foot) >= wall, "the slots are too close to each other"
}
