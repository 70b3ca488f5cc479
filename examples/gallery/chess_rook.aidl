/// A turned chess rook on its board in lamplight: rings, a hollow shaft, a crown of stones, battlements.
assembly chess_rook {
    param height = 100mm in 75..125
    param base = 56mm in 42..70
    param waist = 0.46 in 0.34..0.58
    param merlons = 3 in 2..5 step 1

    let u = base / 100
    let h = height / 100
    let ivory = "#f0d9a8"
    let dark = "#4a3423"
    fn far(k) = 1 / (1 + 0.14 * k)
    fn knot(i, k) = (far(k) * 35 * u * (i - 4), 170 * u * (1 - far(k)) - 44 * u)

    @color(tint) @shade(to) solid bar(tint = "#3b526e", to = "#141c29", low = 0, high = 9) {
        v = rectangle(left: -156 * u, right: 156 * u, bottom: low, top: high)
    }
    wall = bar(low: -62 * u, high: 1.4 * height)
    @color("#ffdf9a") @shade(fade) @opacity(0.6) @stroke(none) @clip(wall.v)
    solid glow { v = circle((0, 58 * h), 0.35 * height + 90 * u) }
    @color("#a17c50") @shade("#e9cb98", -90deg) solid board {
        v = polygon([(-156 * u, -48 * u), (156 * u, -48 * u), knot(8.3, 5.2), knot(-0.3, 5.2)])
    }
    @color("#2b1b12") @shade("#5a3a26") @stroke(none) solid fields {
        for k in 0..4 {
            for i in k % 2..7 step 2 {
                v[i][k] = polygon(knot(i, k), knot(i + 1, k), knot(i + 1, k + 1), knot(i, k + 1))
            }
        }
    }
    edge = bar("#7d4c2c", "#3b2213", low: -62 * u, high: -48 * u)
    @color("#f2c94c") drawing names {
        for i, s in enumerate(["a", "b", "c", "d", "e", "f", "g", "h"]) {
            n[i] = text(s, start: (35 * u * (i - 3.55), -57.5 * u), height: 8 * u)
        }
    }
    @color("black") @shade(fade) @stroke(none)
    solid shadow { v = ellipse((24 * u, 2 * u), 100 * u, 22 * u, angle: 4) }
    @color("#241810") @shade(dark, 0deg)
    solid inside { far_side = rectangle((0, height), 70 * u, 9 * h) }
    /// What a profile makes on the lathe, from its radius at the foot.
    solid turned(low = 9, leaving = (9, 3), arriving = (9, 6), head = (9, 9)) {
        v = path((0, 0), right(low), bezier_to(leaving, arriving, head), left(head.x), mirrored())
    }
    @color(ivory) @shade(round) assembly rook {
        solid foot {
            slab = rectangle((0, 6 * h), base, 9 * h)
            toe = ellipse((0, 1.5 * h), base / 2, 5 * h)
        }
        solid plinth { v = rounded_rectangle((0, 14 * h), 90 * u, 5 * h, 2 * h) }
        ogee = turned(42 * u, (42 * u, 5 * h), (34 * u, 7 * h), (33 * u, 9 * h))
        solid bead { v = slot((0, 27 * h), 74 * u, 5 * h) }
        shaft = turned(32 * u, (waist * 50 * u, 11 * h), (waist * 48 * u, 28 * h), (30 * u, 42 * h))
        solid collar { v = slot((0, 75 * h), 72 * u, 5 * h) }
        solid bell { v = trapezoid((0, 80 * h), 60 * u, 74 * u, 6 * h) }
        solid crown {
            drum = rectangle((0, 85 * h), 78 * u, 12 * h)
            merlon = [rectangle((i, 0), 50 * u / merlons, 10 * h) for i in 1..merlons]
            drawing stones { v = bricks(drum, 13 * u, 6 * h) }
            constrain {
                spread(merlon, inside: drum, axis: x, margin: 0)
                for m in merlon { m.bottom == drum.top }
            }
        }
        constrain {
            column(
                crown.drum,
                bell,
                collar,
                shaft,
                bead,
                ogee,
                plinth,
                foot.slab,
                gap: 0,
                align: center
            )
        }
    }
    @color(dark) @shade("black") solid slit {
        arms = cross_shape((0, 0), width: 10 * u, height: 17 * h, thickness: 3 * u)
    }
    constrain {
        rook.foot.slab.bottom_center == (0, 1.5 * h)
        inside.on_top_of(rook.crown.drum, align: center)
        slit.arms.center == rook.shaft.v.bb.center + (-4 * u, 3 * h)
    }
}
