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
    @color(tint) solid roundel(radius = 10, tint = "#8fc1dd") { v = circle(origin, radius) }
    assembly porthole() { rim = roundel(3.6, "#b98a3a"); pane = roundel(2.2) }
    @color(tint) solid sea(tint = "#4c93c3", high = 0, waves = 6) {
        swell = wave((-95 * l, high), (95 * l, high), amplitude: 2.6, waves: waves)
        bed = polyline([swell.end, (95 * l, -30), (-95 * l, -30), swell.start])
    }
    @color("dimgray") @detached
    drawing gull() { v = path((0, 0), heading: 40, arc_by(-80, 6), arc_by(80, 1), arc_by(-80, 6)) }
    @color("#dbe9f3")
    solid sky { v = rectangle(left: -95 * l, right: 95 * l, bottom: -20, top: mast_height + 24) }
    @color("#ffd34d") @stroke(none)
    solid sun at (-66 * l, 84 * m) { v = star(origin, 17, inner_radius: 13, points: 16) }
    @color("#eef3f7") @detached
    solid cloud at (66 * l, 84 * m) { v = [circle((8 * x, 0), 9 - 2 * abs(x)) for x in -2..2] }
    for i, x in enumerate([-84, -69, 62]) { gulls[i] = gull() at (x * l, (44 + 7 * i) * m) }
    far_sea = sea("#8fc1dd", high: 6, waves: 7)
    @color("slategray")
    drawing rigging { v = [line(tip, p) for p in [(57 * l, 26), (-47 * l, 18), (15 * l, 12)]] }
    @color("#8a5a33")
    solid mast { pole = rectangle(bottom_center: (3 * l, 8), width: 3.6, height: mast_height) }
    @color(sail_color)
    solid pennant { cloth = polygon([(0, 0), (-22, -1), (-16, -5), (-22, -9), (0, -9)]) }
    @color("#fbf7ec") solid main {
        v = path(
            (1.4 * l, 95 * m),
            polyline_to([(1.4 * l, 34), (-42 * l, 36)]),
            bezier_to((-36 * l, 58 * m), (-14 * l, 82 * m), (1.4 * l, 95 * m))
        )
    }
    @color(sail_color) solid bands {
        let t = (95 * m - 42) / (stripes + 0.6)
        v = [clip(rectangle((0, 44 + (i + 0.4) * t), length, t / 2), main.v) for i in 0..<stripes]
    }
    @color(sail_color) solid jib {
        cloth = path(
            (7.5 * l, 92 * m),
            line_to((56 * l, 27)),
            bezier_to((38 * l, 29), (22 * l, 30), (9 * l, 36)),
            bezier_to((14 * l, 54 * m), (13 * l, 74 * m), (7.5 * l, 92 * m))
        )
        @color(darker(sail_color)) drawing seams { v = hatching(cloth, pitch: 13, angle: -20) }
    }
    @color("#8a5a33") solid boom { v = slot((3 * l, 31), (-45 * l, 33), 3.6) }
    @color("#fbf7ec") solid cabin {
        v = path((-34 * l, 6), polyline_to([(-31 * l, 26), (-3 * l, 26), (2 * l, 6)]), close())
        fillet([v.corner[1], v.corner[2]], 3)
    }
    for i in 0..<portholes { lights[i] = porthole() }
    @color("#b0703f") solid hull {
        body = path(
            (-50 * l, 19),
            bezier_to((-24 * l, 8), (26 * l, 8), (58 * l, 27)),
            bezier_to((50 * l, 2), (40 * l, -12), (24 * l, -14)),
            line_to((-40 * l, -14)),
            close()
        )
        @color("#7d4823") drawing joints { v = planks(body, width: 4.5, length: 48 * l) }
    }
    @color("#fbf7ec") solid rail { v = thick(hull.body.segment[0], 3) }
    @color("black") @opacity(0.22) @stroke(none)
    solid shade { v = difference(hull.body, copy(hull.body, by: (0, 8))) }
    near_sea = sea(high: -3, waves: 6)
    front_sea = sea("#3a7cab", high: -15, waves: 5)
    @color("white")
    drawing foam { v = [wave((x * l, -9), (x * l + 16, -9), 1.2, 1.5) for x in [-74, -30, 6, 60]] }
    constrain {
        pennant.right == mast.pole.left
        pennant.top == mast.top
        spread(lights, inside: cabin.v.segment[1], axis: x)
        for a in lights { a.center_y == cabin.v.corner[1].y - 6 }
    }
}
