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

    /// A bar between two points; light falls on its left, or on top.
    @color(tint) @shade(round, written(atan2(b.y - a.y, b.x - a.x)) - 90deg)
    solid tube(a = (0, 0), b = (10, 0), size = 3.6, tint = paint) { v = slot(a, b, size) }
    @color(tint) @shade(to) solid band(tint = "gray", to = "gray", low = 0, high = 9) {
        v = rectangle(left: -r - 24, right: wheelbase + r + 24, bottom: low, top: high)
    }
    sky = band("#a8d3ea", "#f6f3e4", -r, r + 56)
    @color("#b5d39c") @shade("#86b070") @stroke(none) solid hills {
        far = dome((0.34 * wheelbase, 0), wheelbase + 1.6 * r, 2 * r)
        near = dome((wheelbase, -0.3 * r), 2 * r + 46, 1.4 * r)
    }
    road = band("#a9adb2", "#74787e", -r - 20, -r + 9)
    @color("black") @opacity(0.3) @stroke(none) solid shadow {
        v = ellipse((wheelbase / 2 + 6, -r - 2), wheelbase / 2 + 0.8 * r, 5)
    }
    assembly tyred_wheel() {
        let t = 360 / spokes
        @color("#8a9097") @stroke(0.45) drawing wires {
            v = [line(
                polar(2.6, t * i + 90 - 180 * (i % 2)), polar(r - 4, t * i)
            ) for i in 0..<spokes]
        }
        @color("#38383e") @shade(slope)
        solid tyre { v = ring(origin, outer_radius: r, thickness: 3) }
        @color("silver") @shade(slope)
        solid rim { v = ring(origin, outer_radius: r - 3, thickness: 1.6) }
        @color("silver") @shade(ball) solid hub { v = circle(origin, radius: 3) }
    }
    @color(paint) @shade(slope)
    solid mudguard(from = 20, to = 170) { v = ring_sector(origin, r + 3.6, r + 1.6, from, to) }
    @color("#2e2e33")
    solid pedal(angle = 0) { v = rounded_rectangle(crank + polar(15, angle), 11, 3.4, 1.2) }
    back_wheel = tyred_wheel() at rear
    front_wheel = tyred_wheel() at front
    back_guard = mudguard(32, 178) at rear
    front_guard = mudguard(40, 165) at front
    far_pedal = pedal(130)
    far_crank = tube(crank, crank + polar(15, 130), 2.4, "gray")
    reflector = tube((-r - 1, 2), (-r - 1, 6), 4, "red")
    rack = tube((-26, r + 8), seat + (0, -4), 2, "#2e2e33")
    rack_stay = tube(rear, (-20, r + 8), 1.6, "#2e2e33")
    seat_stay = tube(rear, seat, 2.4)
    chain_stay = tube(rear, crank, 2.8)
    seat_post = tube(seat, post, 2.6, "silver")
    seat_tube = tube(crank, seat)
    top_tube = tube(seat + (0.6, -3), head + (1, -4))
    down_tube = tube(crank, crown + (-1.4, 3))
    @color(darker(paint, 0.1)) @shade(round)
    solid fork { v = thick(path(crown, bezier_to(front + (-7, r / 2), front + (-6, 6), front)), 3) }
    quill = tube(head, stem, 2.8, "silver")
    head_tube = tube(crown, head, 5)
    @color("silver") @shade(round) solid handlebar {
        way = path(stem, bezier_to(stem + (11, 1), stem + (9, 11), stem + (-6, 8.4)))
        v = thick(way, 2.2)
    }
    grip = tube(stem + (-15, 6.5), stem + (-5, 8.6), 3.4, "sienna")
    bell = tube(stem + (5, 9), stem + (5, 10), 4, "gold")
    holder = tube(head + (2, -6.5), head + (27, -6.5), 2, "#2e2e33")
    @color("#d9a860") @shade(round) assembly basket at head + (19, 3) {
        for i in 0..2 {
            @color(["tomato", "gold", "orchid"][i]) @shade(ball)
            solid rose[i] { v = rosette(outer_radius: 5, inner_radius: 4, lobes: 7) }
            constrain rose[i].v.center == weave.v.bb.top_center + (7 * i - 7, 3 - i % 2)
        }
        solid weave { v = trapezoid(origin, bottom_width: 20, top_width: 26, height: 17) }
        @color("sienna") drawing wicker { v = crosshatch(weave.v, pitch: 3) }
        solid hem { v = rounded_rectangle(width: 29, height: 3, radius: 1.5) }
        constrain hem.center == weave.v.bb.top_center
    }
    lamp = tube(crown + (5, 1), crown + (8, 1), 6, "gold")
    @color("sienna") @shade(round, -90deg) solid saddle at post {
        v = hull(ellipse((-8, 1.2), 6.5, 3.6), ellipse((8, 2), 6.5, 1.4))
    }
    @color("#3c3c42") @stroke(1.2) @dash(1.5, 0.6)
    drawing chain { v = hull(circle(crank, 8.6), circle(rear, 4)) }
    @color("silver") @shade(ball) solid sprocket {
        v = cog(crank, outer_radius: 8.6, inner_radius: 7.4, teeth: 18)
        hole h { v = [circle(crank + polar(4.8, 72 * i), 1.8) for i in 0..4] }
    }
    near_crank = tube(crank, crank + polar(15, -50), 2.8, "gray")
    near_pedal = pedal(-50)
}
