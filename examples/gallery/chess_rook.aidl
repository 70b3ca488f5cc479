/// A turned chess rook on its board in lamplight: rings, a hollow shaft, a crown of stones, battlements.
assembly chess_rook {
    param height = 100mm in 75..125
    param base = 56mm in 42..70
    param waist = 0.46 in 0.34..0.58
    param merlons = 3 in 2..5 step 1

    let u = base / 100
    let h = height / 100
    let ivory = "#ecd9b0"
    let dark = darker(ivory, 0.55)
    fn far(k) = 1 / (1 + 0.14 * k)
    fn knot(i, k) = (far(k) * 35 * u * (i - 4), 170 * u * (1 - far(k)) - 44 * u)

    @color(tint) solid bar(tint = "#2c3a4d", low = 0, high = 9) {
        v = rectangle(left: -156 * u, right: 156 * u, bottom: low, top: high)
    }
    wall = bar(low: -62 * u, high: 1.4 * height)
    @color("#41536c") solid halo { v = circle(radius: 0.42 * height + 26 * u) }
    @color("#d8b988") solid board {
        v = polygon([(-156 * u, -48 * u), (156 * u, -48 * u), knot(8.3, 5.2), knot(-0.3, 5.2)])
    }
    @color("#3f2a1c") solid fields {
        for k in 0..4 {
            for i in k % 2..7 step 2 {
                v[i][k] = polygon(knot(i, k), knot(i + 1, k), knot(i + 1, k + 1), knot(i, k + 1))
            }
        }
    }
    edge = bar("#5d371d", low: -62 * u, high: -48 * u)
    @color("gold") drawing names {
        for i, s in enumerate(["a", "b", "c", "d", "e", "f", "g", "h"]) {
            n[i] = text(s, center: (35 * u * (i - 3.5), -55 * u), height: 8 * u)
        }
    }
    @color("#1d130c") @opacity(0.6) solid shadow { v = ellipse((38 * u, 3 * u), 78 * u, 12 * u) }
    @color(dark) solid inside { far_side = rectangle((0, height), 70 * u, 9 * h) }
    @color(ivory) solid rook {
        foot = rounded_rectangle((0, 6), base, 9 * h, 3 * h)
        plinth = rounded_rectangle((0, 14), 90 * u, 5 * h, 2 * h)
        ogee = path(
            (0, 0),
            right(42 * u),
            bezier_to((42 * u, 5 * h), (34 * u, 7 * h), (33 * u, 9 * h)),
            left(33 * u),
            mirrored()
        )
        bead = slot((0, 27), 74 * u, 5 * h)
        shaft = path(
            (0, 0),
            right(32 * u),
            bezier_to((waist * 50 * u, 11 * h), (waist * 48 * u, 28 * h), (30 * u, 42 * h)),
            left(30 * u),
            mirrored()
        )
        collar = slot((0, 75), 72 * u, 5 * h)
        bell = trapezoid((0, 80), 60 * u, 74 * u, 6 * h)
        drum = rounded_rectangle((0, 85), 78 * u, 12 * h, h)
        merlon = [rectangle((i, 0), 50 * u / merlons, 10 * h) for i in 1..merlons]
        constrain {
            column(drum, bell, collar, shaft, bead, ogee, plinth, foot, gap: 0, align: center)
            evenly_spaced(merlon, axis: x)
            for m in merlon { m.bottom == drum.top }
            merlon[0].left == drum.left
            merlon[-1].right == drum.right
        }
    }
    let stem = [rook.foot, rook.plinth, rook.ogee, rook.bead, rook.shaft, rook.collar, rook.bell]
    for i, p in enumerate(stem) {
        @color(ivory) solid part[i] { v = offset(p, 0) }
    }
    @color(darker(ivory, tone)) solid shade(tone = 0.2, share = 0.34) {
        v = [difference(p, copy(p, by: (-share * 80 * u, 0))) for p in stem + [rook.drum]]
        m = [difference(p, copy(p, by: (-share * 40 * u / merlons, 0))) for p in rook.merlon]
    }
    half_shade = shade()
    full_shade = shade(0.38, 0.15)
    @color(dark) solid slit {
        arms = cross_shape((0, 0), width: 10 * u, height: 17 * h, thickness: 3 * u)
        drawing stones { v = bricks(rook.drum, 13 * u, 6 * h) }
    }
    constrain {
        rook.foot.bottom_center == (0, 0)
        inside.on_top_of(rook.drum, align: center)
        slit.arms.center == rook.shaft.bb.center + (-7 * u, 3 * h)
        halo.v.center == rook.shaft.bb.center + (0, 10 * h)
    }
}
