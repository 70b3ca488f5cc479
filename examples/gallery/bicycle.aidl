/// A town bicycle from the side: spoked wheels, diamond frame, chain drive, leather saddle and basket.
assembly bicycle {
    param wheel_diameter = 66mm in 49..83
    param wheelbase = 108mm in 81..135
    param spokes = 18 in 12..24 step 2
    param saddle_height = 12 in 7..20
    param paint = "teal" in ["teal", "crimson", "darkorange"]
    let r = wheel_diameter / 2
    let rear = (0, 0)
    let front = (wheelbase, 0)
    let crank = (0.42 * wheelbase, -4)
    let seat = (0.29 * wheelbase, r + 12)
    let head = (wheelbase - 21, r + 17)
    let crown = (wheelbase - 14, r + 3)
    let post = seat + saddle_height * unit(seat - crank)
    let stem = head + 9 * unit(head - crown)

    /// A bar between two points.
    @color(tint)
    solid tube(a = (0, 0), b = (10, 0), size = 3.6, tint = paint) { v = slot(a, b, size) }
    assembly tyred_wheel() {
        @color("#6b7078") drawing wires {
            let t = 360 / spokes
            v = [line(
                polar(2.6, t * i + 90 - 180 * (i % 2)), polar(r - 4, t * i)
            ) for i in 0..<spokes]
        }
        @color("#2e2e33") solid tyre { v = ring(origin, outer_radius: r, thickness: 3) }
        @color("silver") solid rim { v = ring(origin, outer_radius: r - 3, thickness: 1.6) }
        @color("silver") solid hub { v = circle(origin, radius: 3) }
    }
    @color(paint)
    solid mudguard(from = 20, to = 170) { v = ring_sector(origin, r + 3.6, r + 1.6, from, to) }
    @color("#2e2e33")
    solid pedal(angle = 0) { v = rounded_rectangle(crank + polar(15, angle), 11, 3.4, 1.2) }
    road = tube((-46, -r - 2), (wheelbase + 46, -r - 2), 4, "#9aa0a6")
    back_wheel = tyred_wheel() at rear
    front_wheel = tyred_wheel() at front
    back_guard = mudguard(32, 178) at rear
    front_guard = mudguard(40, 165) at front
    far_pedal = pedal(130)
    far_crank = tube(crank, crank + polar(15, 130), 2.4, "gray")
    rack = tube((-26, r + 8), seat + (0, -4), 2, "#2e2e33")
    rack_stay = tube(rear, (-20, r + 8), 1.6, "#2e2e33")
    seat_stay = tube(rear, seat, 2.4)
    chain_stay = tube(rear, crank, 2.8)
    seat_post = tube(seat, post, 2.6, "silver")
    seat_tube = tube(crank, seat)
    top_tube = tube(seat + (0.6, -3), head + (1, -4))
    down_tube = tube(crank, crown + (-1.4, 3))
    @color(darker(paint, 0.2))
    solid fork { v = thick(path(crown, bezier_to(front + (-7, r / 2), front + (-6, 6), front)), 3) }
    quill = tube(head, stem, 2.8, "silver")
    head_tube = tube(crown, head, 5)
    @color("silver") solid handlebar {
        way = path(stem, bezier_to(stem + (11, 1), stem + (9, 11), stem + (-6, 8.4)))
        v = thick(way, 2.2)
    }
    grip = tube(stem + (-15, 6.5), stem + (-5, 8.6), 3.4, "sienna")
    bell = tube(stem + (5, 9), stem + (5, 10), 4, "gold")
    holder = tube(head + (2, -6), head + (12, -6), 2, "#2e2e33")
    @color("#d9a860") solid basket {
        weave = trapezoid(head + (17, 3), bottom_width: 20, top_width: 26, height: 17)
        @color("sienna") drawing wicker { v = crosshatch(weave, pitch: 3) }
    }
    lamp = tube(crown + (5, 1), crown + (8, 1), 6, "gold")
    @color("sienna") solid saddle at post {
        v = path(
            (-13, 0),
            bezier_to((-15, 6), (-9, 7), (-4, 4.6)),
            bezier_to((2, 2.4), (9, 4), (14, 2)),
            bezier_to((14, -1), (9, 0), (4, -1)),
            bezier_to((0, -2), (-6, -3), (-13, 0))
        )
    }
    @color("dimgray") drawing chain { v = hull(circle(crank, 8.6), circle(rear, 4)) }
    @color("silver") solid sprocket {
        v = cog(crank, outer_radius: 8.6, inner_radius: 7.4, teeth: 18)
        hole h { v = [circle(crank + polar(4.8, 72 * i), 1.8) for i in 0..4] }
    }
    near_crank = tube(crank, crank + polar(15, -50), 2.8, "gray")
    near_pedal = pedal(-50)
    constrain {
        align_bottom(front_wheel, back_wheel)
        basket.weave.on_top_of(holder)
        basket.weave.bb.left == head_tube.v.bb.right - 1
    }
}
