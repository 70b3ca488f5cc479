/// A friendly tin robot: glass lamps for eyes, a grin, ears, rivets, and an antenna with a bulb.
assembly robot_face {
    param width = 160mm in 120..210
    param tallness = 0.85 in 0.63..1.07
    param eye = 0.26 in 0.19..0.33
    param teeth = 7 in 4..10 step 1
    param rivets = 4 in 2..6 step 1

    let w = width / 100
    let tall = tallness * width
    let tin = "#6fa3b8"
    let steel = "#69737f"
    let brass = "#e3b04a"
    let ink = "#22303c"
    @color(tint) @shade(ball)
    solid ball(tint = brass, radius = 3.6 * w) { v = circle(origin, radius) }
    @color("#ff8a80") @shade(fade) @stroke(none) solid glow { v = circle(radius: 17 * w) }
    bulb = ball("#e5484d", 6 * w)
    @color(brass) @detached solid waves {
        right = [thick(arc(origin, r * w, -35deg, 35deg), 1.6 * w, "butt") for r in [11, 16, 21]]
        left = mirror(right, about: y_axis)
    }
    @color(steel) @shade(round) @edges(seams) solid antenna {
        foot = dome(width: 26 * w, height: 8 * w)
        rod = rectangle(width: 3 * w, height: 18 * w)
        for i in 0..2 { coil[i] = slot(length: 9 * w, width: 3 * w) }
        constrain {
            rod.stacked_on(foot)
            spread(coil, inside: rod, axis: y, margin: 2)
            for c in coil { centered_horizontally(c, rod) }
        }
    }
    @color(steel) @shade(round) solid neck { pipe = rectangle(width: 40 * w, height: 14 * w) }
    @color("black") @opacity(0.35) @stroke(none)
    solid bellows { folds = slats(neck.pipe, width: 2 * w, gap: 2.5 * w) }
    @color(darker(tin, 0.2)) @shade(round) solid collar {
        v = trapezoid(bottom_width: 112 * w, top_width: 84 * w, height: 24 * w)
        fillet([v.corners[2], v.corners[3]], 12 * w)
    }
    buttons = [ball() for i in -2..2]
    @color(brass) @shade(round, 90deg) @edges(seams) solid right_ear {
        axle = rectangle(width: 6 * w, height: 12 * w)
        disc = rounded_rectangle(width: 7 * w, height: 32 * w, radius: 3 * w)
        knob = rounded_rectangle(width: 5 * w, height: 16 * w, radius: 2.4 * w)
        constrain row(axle, disc, knob, gap: 0, align: center)
    }
    left_ear = mirror(right_ear, about: y_axis)
    assembly head {
        @color(tin) @shade(round) solid shell { v = rounded_rectangle(origin, width, tall, 14 * w) }
        @clip(shell.v) @stroke(none) assembly gloss {
            @color("black") @opacity(0.2)
            solid low { v = rectangle((0, 2.5 * w - tall / 2), width, 5 * w) }
            @color("white") @opacity(0.3)
            solid high { v = rectangle((0, tall / 2 - 2 * w), width, 4 * w) }
        }
        @color(lighter(tin, 0.35)) @shade(slope)
        solid plate { v = rounded_rectangle(origin, 90 * w, tall - 14 * w, 9 * w) }
        @color("#2c3a46") @shade("#546a7b")
        solid visor { v = rounded_rectangle((0, 0.14 * tall), 76 * w, 0.44 * tall, 12 * w) }
    }
    assembly studs {
        for i in 0..<rivets { left[i] = ball("#dfe6ea", 2 * w) at (-41.5 * w, 10 * i) }
    }
    right_studs = mirror(studs, about: y_axis)
    assembly lamp(d = min(eye, 0.34 * tallness) * width) {
        for i, size in enumerate([1.18, 1, 0.68]) {
            @color([brass, ink, "#3fd8c6"][i]) @shade(ball)
            solid disc[i] { v = circle(center: origin, diameter: size * d) }
        }
        @color("#0c5a5f")
        drawing rays { v = polar_array(line((0, 0), (0.08 * d, 0)), n: 24, radius: 0.25 * d) }
        @color("#0c3b44") @shade(slope)
        solid pupil { v = cog(outer_radius: 0.22 * d, inner_radius: 0.16 * d, teeth: 8) }
        @color(ink) @shade(slope)
        solid brow { v = arc_slot(origin, 0.69 * d, 3.6 * w, 58deg, 122deg) }
        @color("white") @opacity(0.9) @stroke(none) solid glint {
            v = [circle((-k * d, k * d), (0.06 + 0.2 * k) * d) for k in [0.14, -0.1]]
        }
    }
    for s in [-1, 1] { eyes[s] = lamp() at (20 * s * w, 14 * w) }
    nose = ball("#e5484d", 4 * w) at (0, -5 * w)
    @color(ink) @shade(slope)
    solid mouth { v = arc_slot(origin, 42 * w, min(14 * w, 0.17 * tall), 237deg, 303deg) }
    @color("#fff8e4") @shade(slope)
    solid grin { v = ribs(mouth.v, 56 * w / teeth, 46 * w / teeth, margin: 2.5 * w) }
    constrain {
        glow.center == bulb.center
        waves.origin == bulb.center
        for i, b in enumerate(buttons) { b.center == collar.center + (12 * (i - 2) * w, 0) }
        column(bulb, antenna, head, neck, collar, gap: 0, align: center)
        right_ear.right_of(head, gap: 0, align: center)
        for s in [-1, 1] { eyes[s].origin == head.visor.center + (20 * s * w, 0) }
        mouth.center == head.center - (0, 0.27 * tall)
        nose.v.center.y == head.center.y - 0.08 * tall
        spread(studs.left, inside: head.plate, axis: y, margin: 9 * w)
    }
}
