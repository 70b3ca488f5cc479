/// A farm tractor running to the right: a great lugged wheel, a small one, a ribbed bonnet, a cab and a stack.
assembly tractor {
    param rear = 110mm in 82..140
    param front = 0.58 in 0.43..0.73
    param wheelbase = 150mm in 112..190
    param lugs = 26 in 19..34 step 1
    param cab = 82mm in 61..104

    let green = "#2f8f3e"
    let floor = 0.5 * rear + 4
    let nose = wheelbase + 22

    @color(tint) solid strip_(tint = "#d6e8f2", low = -24, high = 1.2) {
        v = rectangle(left: -0.8 * rear, right: wheelbase + 80, bottom: low, top: high)
    }
    sky = strip_(high: floor + cab + 58)
    @color("#ffd95e") solid sun { v = circle((nose + 30, floor + cab + 30), 15) }
    @color("#a8c686")
    solid hills { v = clip([ellipse((x, 0), 150, floor - 10) for x in [-50, nose]], sky.v) }
    soil = strip_("#8a6b48")
    @color("#5d4530") drawing furrows { lines = bricks(soil.v, 32, 5) }
    @color("#4a4f57") solid stack at (wheelbase - 26, floor + 62) {
        pipe = rectangle((0, 2), 6, 56)
        muffler = rounded_rectangle((0, 0), 12, 24, 4)
        flap = slot((3, 31), 12, 3, angle: 25deg)
    }
    @color("#f4f6f8") solid smoke { v = [circle((-i * i - 4 * i, 3 * i), 3 + i) for i in 0..4] }
    @color("#eef7fb")
    solid glass { pane = trapezoid((0, floor + cab / 2 + 9), 86, 74, height: cab) }
    @color("#2b3138") solid interior {
        seat = slot((-24, floor + 22), (-27, floor + 48), 9)
        wheel = strip((10, floor + 40), (26, floor + 51), 4)
    }
    @color(darker(green, 0.25)) solid pillars {
        bars = shell(glass.pane, 4.5)
    }
    @color(green) solid roof { cap = rounded_rectangle((2, floor + cab + 14), 98, 11, 5) }
    @color("#3a4048") solid chassis {
        frame = rectangle(left: -30, right: nose - 4, bottom: floor - 26, top: floor + 4)
        hitch = thick(polyline((-30, floor - 14), (-0.55 * rear - 10, floor - 24)), 5)
    }
    @color(green) solid bonnet {
        hood = path(
            (40, floor),
            polyline_to([(nose, floor), (nose, floor + 28)]),
            bezier_to((nose, floor + 40), (nose - 20, floor + 44), (40, floor + 48)),
            close()
        )
    }
    @color(darker(green, 0.35)) solid louvres {
        construction field = rectangle(start: (nose - 84, floor + 12), end: (nose - 26, floor + 26))
        slits = ribs(field, pitch: 6, width: 3)
    }
    @color("#f2d544")
    solid stripe { v = clip(rectangle((nose, floor + 5), 2 * nose, 6), by: bonnet.hood) }
    @color("white") drawing maker {
        v = text("FARM", center: (nose - 52, floor + 33), height: 8)
        shine = line((46, floor + 44), (nose - 22, floor + 38))
    }
    @color("#fff3b0") solid lamp { glass = ellipse((nose - 5, floor + 24), 4, 7) }
    @color(green) solid mudguard { v = thick(arc((0, rear / 2), rear / 2 + 10, 25deg, 160deg), 9) }
    assembly big_wheel(d = 80mm, n = 24) {
        @color("#2a2c30")
        solid tyre { v = cog(outer_radius: 0.5 * d, inner_radius: 0.46 * d, teeth: n) }
        let tints = ["#43464c", "#f2c230", "#d09a1c", "#f2c230", "#5a5f66"]
        for i, r in enumerate([0.42, 0.3, 0.25, 0.13, 0.06]) {
            @color(tints[i]) solid disc[i] { v = circle(center: origin, radius: r * d) }
        }
        @color("#6b5414") solid bolts {
            v = polar_array(circle(radius: 0.016 * d), n: 8, radius: 0.1 * d)
            w = polar_array(circle(radius: 0.034 * d), n: 6, radius: 0.19 * d)
        }
        drawing tread {
            v = polar_array(line((0, 0), (0.05 * d, 0.03 * d)), n: n, radius: 0.4 * d)
        }
    }
    rear_wheel = big_wheel(d: rear, n: lugs) at (0, rear / 2)
    front_wheel = big_wheel(d: front * rear, n: lugs - 4) at (wheelbase, 30)

    constrain {
        front_wheel.disc[0].v.center == fixed((wheelbase, front * rear / 2))
        smoke.v[0].center == stack.pipe.top_center + (0, 8)
    }
}
