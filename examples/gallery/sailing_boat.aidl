/// A wooden sailing boat under way: planked hull, cabin with portholes, striped mainsail, jib, pennant and waves.
assembly sailing_boat {
    param length = 130mm in 97..163
    param mast_height = 140mm in 105..175
    param stripes = 3 in 2..5 step 1
    param portholes = 3 in 2..4 step 1
    param sail_color = "#c8473c" in ["#c8473c", "#2f6f9f", "#d99a2b"]
    let l = length / 100
    let m = mast_height / 100
    let tip = (3 * l, 97 * m)
    let canvas = "#fffaf0"
    let wood = "#9a6034"
    @color(tint) @shade(other)
    solid roundel(tint = "#e8f4f8", radius = 2.2, other = "#5f97b8") { v = circle(origin, radius) }
    assembly porthole() { rim = roundel("#c9973f", 3.6, "ball"); pane = roundel() }
    @color(tint) @shade(darker(tint, 0.35)) solid sea(tint = "#4c9cc9", high = 0, waves = 6) {
        swell = wave((-95 * l, high), (95 * l, high), amplitude: 2.6, waves: waves)
        bed = polyline([swell.end, (95 * l, -30), (-95 * l, -30), swell.start])
    }
    @color("dimgray") @detached
    drawing gull() { v = path((0, 0), heading: 40, arc_by(-80, 6), arc_by(80, 1), arc_by(-80, 6)) }
    @color("#ffffff") @shade("#cfdfea") @stroke(none) @detached
    solid cloud(size = 9) { v = [circle((size * x, 0), size - 2 * abs(x)) for x in -2..2] }
    @color("#7fb6de") @shade("#f6ead2")
    solid sky { v = rectangle(left: -95 * l, right: 95 * l, bottom: -20, top: mast_height + 24) }
    @color("#fff0b0") @shade(fade) @stroke(none) @clip(sky.v)
    solid halo at (-66 * l, 84 * m) { v = circle(radius: 36) }
    @stroke(none) sun = roundel("#ffe37a", 12, "#ffb733") at (-66 * l, 84 * m)
    near_cloud = cloud() at (66 * l, 84 * m)
    far_cloud = cloud(7) at (-74 * l, 56 * m)
    for i, x in enumerate([-84, -60, 62]) { gulls[i] = gull() at (x * l, (38 + 8 * i) * m) }
    @color("#8fb0b8") @shade("#6d9a86") @stroke(none)
    solid island {
        v = [ellipse((x * l, 4), w * l, h) for x, w, h in [[-66, 24, 15], [74, 21, 10]]]
    }
    far_sea = sea("#9ccfe6", high: 6, waves: 7)
    @color("slategray")
    drawing rigging { v = [line(tip, p) for p in [(57 * l, 26), (-47 * l, 18), (15 * l, 12)]] }
    @color(wood) @shade(round)
    solid mast { pole = rectangle(bottom_center: (3 * l, 8), width: 3.6, height: mast_height) }
    @color(sail_color) @shade(slope)
    solid pennant { cloth = polygon([(0, 0), (-24, -2), (-17, -6), (-24, -10), (0, -9)]) }
    @color(canvas) @shade("#d3c7b4", 10deg) solid main {
        v = path(
            (1.4 * l, 95 * m),
            polyline_to([(1.4 * l, 34), (-42 * l, 36)]),
            bezier_to((-36 * l, 58 * m), (-14 * l, 82 * m), (1.4 * l, 95 * m))
        )
    }
    @color(lighter(sail_color, 0.1)) @shade(darker(sail_color, 0.3), 10deg) solid bands {
        let t = (95 * m - 42) / (stripes + 0.6)
        v = [clip(rectangle((0, 44 + (i + 0.4) * t), length, t / 2), main.v) for i in 0..<stripes]
    }
    @color(lighter(sail_color, 0.15)) @shade(darker(sail_color, 0.25), 10deg) solid jib {
        cloth = path(
            (7.5 * l, 92 * m),
            line_to((56 * l, 27)),
            bezier_to((38 * l, 29), (22 * l, 30), (9 * l, 36)),
            bezier_to((14 * l, 54 * m), (13 * l, 74 * m), (7.5 * l, 92 * m))
        )
        @color(darker(sail_color)) drawing seams { v = hatching(cloth, pitch: 13, angle: -20) }
    }
    @color(wood) @shade(round, 90deg) solid boom { v = slot((3 * l, 31), (-45 * l, 33), 3.6) }
    @color(canvas) @shade(slope) solid cabin {
        v = path((-34 * l, 6), polyline_to([(-31 * l, 26), (-3 * l, 26), (2 * l, 6)]), close())
        fillet([v.corner[1], v.corner[2]], 3)
    }
    for i in 0..<portholes { lights[i] = porthole() }
    @color("#c27d48") @shade("#5c3218") solid hull {
        body = path(
            (-50 * l, 19),
            bezier_to((-24 * l, 8), (26 * l, 8), (58 * l, 27)),
            bezier_to((50 * l, 2), (40 * l, -12), (24 * l, -14)),
            line_to((-40 * l, -14)),
            close()
        )
        @color("#6b3c1d") drawing joints { v = planks(body, width: 4.5, length: 48 * l) }
    }
    @color(canvas) @shade(slope) solid rail { v = thick(hull.body.segment[0], 3) }
    @color("gold")
    drawing name { v = text("AURORA", start: (22 * l, 5), height: 3 * l, bold: true) }
    near_sea = sea(high: -3, waves: 6)
    @color("#14344a") @shade(fade) @opacity(0.6) @stroke(none)
    solid under { v = ellipse((2 * l, -13), 52 * l, 6) }
    front_sea = sea("#3a80b2", high: -15, waves: 5)
    @color("white") @opacity(0.6) @stroke(none) @detached
    solid foam {
        v = [lens((x * l, y), w, 1.4) for x, y, w in [
            [-74, -8, 14], [50, -5, 18], [58, -20, 22], [-30, -21, 26], [80, -11, 12]
        ]]
    }
    constrain {
        pennant.right == mast.pole.left
        pennant.top == mast.top
        spread(lights, inside: cabin.v.segment[1], axis: x)
        for a in lights { a.center_y == cabin.v.corner[1].y - 6 }
    }
}
