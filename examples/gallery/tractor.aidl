/// A farm tractor running to the right: a great lugged wheel, a small one, a ribbed bonnet, a cab and a stack.
assembly tractor {
    param rear = 110mm in 82..140
    param front = 0.58 in 0.43..0.73
    param wheelbase = 150mm in 112..190
    param lugs = 26 in 19..34 step 1
    param cab = 82mm in 61..104
    let green = "#2f9440"
    let floor = 0.5 * rear + 4
    let nose = wheelbase + 22
    let west = -0.8 * rear
    let east = wheelbase + 80
    @color(tint) @shade(other)
    solid strip_(tint = "#86bfe6", other = "#f7efd6", low = -24, high = 1.2) {
        v = rectangle(left: west, right: east, bottom: low, top: high)
    }
    sky = strip_(high: floor + max(cab, 74) + 58)
    @color("#ffe9a0") @shade(fade) @stroke(none) @clip(sky.v)
    solid halo { v = circle((nose + 30, floor + cab + 26), 40) }
    @color("#ffe37a") @shade("#ffb733") @stroke(none)
    solid sun { v = circle((nose + 30, floor + cab + 26), 14) }
    @color("#a9cf8c") @shade("#6f9f63") @stroke(none)
    solid hills { v = clip([ellipse((x, 0), east - 60, floor - 10) for x in [-50, nose]], sky.v) }
    @color("#4f8f4b") @shade(slope) @stroke(none)
    solid hedge { v = clip([circle((x, 4), 13 - x % 5) for x in west..east + 9 step 17], sky.v) }
    soil = strip_("#9a7650", "#5f452d")
    @color("#5d4530") drawing furrows {
        for i in 1..3 { v[i] = wave((west, -6 * i), (east, -6 * i), 1.3, waves: 14) }
    }
    @color("black") @opacity(0.35) @stroke(none)
    solid cast { v = ellipse((0.45 * wheelbase, 0), 0.52 * wheelbase + 0.45 * rear, 6) }
    @color("#565c66") @shade(round) solid stack at (wheelbase - 26, floor + 62) {
        pipe = rectangle((0, 2), 6, 56)
        muffler = rounded_rectangle((0, 0), 12, 24, 4)
        flap = slot((3, 31), 12, 3, angle: 25deg)
    }
    @color("#ffffff") @shade("#b9c2ca") @stroke(none) @opacity(0.85)
    solid smoke { v = [circle((-i * i - 4 * i, 3 * i), 3 + i) for i in 0..4] }
    @color("#f2fafd") @shade("#9cc6dc", -60deg)
    solid glass { pane = trapezoid((0, floor + cab / 2 + 9), 86, 74, height: cab) }
    @color("#2b3138") @shade(slope) solid interior {
        seat = slot((-24, floor + 22), (-27, floor + 48), 9)
        wheel = strip((10, floor + 40), (26, floor + 51), 4)
    }
    @color("white") @opacity(0.45) @stroke(none) @clip(glass.pane)
    solid glare { v = [parallelogram((x, floor + cab / 2), 9, cab + 20, 26) for x in [-8, 8]] }
    @color(darker(green, 0.25)) @shade(round) solid pillars { bars = shell(glass.pane, 4.5) }
    @color(green) @shade(round, 90deg)
    solid roof { cap = rounded_rectangle((2, floor + cab + 14), 98, 11, 5) }
    @color("#f7a928") @shade(ball)
    solid beacon { v = dome(bottom_center: (-32, floor + cab + 19), width: 10, height: 9) }
    @color("#434a53") @shade(slope) solid chassis {
        frame = rectangle(left: -30, right: nose - 4, bottom: floor - 26, top: floor + 4)
        hitch = thick(polyline((-30, floor - 14), (-0.55 * rear - 10, floor - 24)), 5)
    }
    @color(green) @shade(round, 90deg) solid bonnet {
        hood = path(
            (40, floor),
            polyline_to([(nose, floor), (nose, floor + 28)]),
            bezier_to((nose, floor + 40), (nose - 20, floor + 44), (40, floor + 48)),
            close()
        )
    }
    @color(darker(green, 0.6)) @stroke(none) solid louvres {
        construction field = rectangle(start: (nose - 83, floor + 12), end: (nose - 26, floor + 26))
        slits = ribs(field, pitch: 6, width: 3)
    }
    @color("#f2d544") @shade(slope)
    solid stripe { v = clip(rectangle((nose, floor + 5), 2 * nose, 6), by: bonnet.hood) }
    @color("white")
    drawing maker { v = text("FARM", center: (nose - 52, floor + 33), height: 8, bold: true) }
    @color("#fff3b0") @shade(ball) solid lamp { glass = ellipse((nose - 5, floor + 24), 4, 7) }
    @color(green) @shade(round, -50deg)
    solid mudguard { v = thick(arc((0, rear / 2), rear / 2 + 10, 25deg, 160deg), 9) }
    assembly big_wheel(d = 80mm, n = 24) {
        @color("#34373c") @shade(ball)
        solid tyre { v = cog(outer_radius: 0.5 * d, inner_radius: 0.46 * d, teeth: n) }
        drawing tread {
            v = polar_array(line((0, 0), (0.05 * d, 0.03 * d)), n: n, radius: 0.39 * d)
        }
        let tints = ["#4d5158", "#f6c935", "#c08f18", "#f6c935", "#6b7178"]
        for i, r in enumerate([0.37, 0.3, 0.25, 0.13, 0.06]) {
            @color(tints[i]) @shade(ball)
            solid disc[i] { v = circle(center: origin, radius: r * d) }
        }
        @color("#6b5414") @shade(slope) solid bolts {
            v = polar_array(circle(radius: 0.016 * d), n: 8, radius: 0.1 * d)
            w = polar_array(circle(radius: 0.034 * d), n: 6, radius: 0.19 * d)
        }
    }
    rear_wheel = big_wheel(d: rear, n: lugs) at (0, rear / 2)
    front_wheel = big_wheel(d: front * rear, n: lugs - 4) at (wheelbase, 30)

    constrain {
        front_wheel.disc[0].v.center == fixed((wheelbase, front * rear / 2))
        smoke.v[0].center == stack.pipe.top_center + (0, 8)
    }
}
