/// A friendly tin robot: lamps for eyes, a grin, ears, rivets, and an antenna with a bulb.
assembly robot_face {
    param width = 160mm in 120..210
    param tallness = 0.85 in 0.63..1.07
    param eye = 0.26 in 0.19..0.33
    param teeth = 7 in 4..10 step 1
    param rivets = 4 in 2..6 step 1

    let w = width / 100
    let tall = tallness * width
    let tin = "#6f9bb0"
    let steel = "#5b6470"
    let brass = "#e0b04c"
    let red = "#e5484d"
    @color(red) solid bulb { lamp = circle(radius: 6 * w) }
    @color(brass) @detached solid waves {
        right = [thick(arc(origin, r * w, -35deg, 35deg), 1.6 * w, "butt") for r in [11, 16, 21]]
        left = mirror(right, about: y_axis)
    }
    @color(steel) solid antenna {
        foot = dome(width: 26 * w, height: 8 * w)
        rod = rectangle(width: 3 * w, height: 18 * w)
        for i in 0..2 { coil[i] = slot(length: 9 * w, width: 3 * w) }
        constrain {
            rod.stacked_on(foot)
            spread(coil, inside: rod, axis: y, margin: 2)
            for c in coil { centered_horizontally(c, rod) }
        }
    }
    @color(steel) solid neck { pipe = rectangle(width: 40 * w, height: 14 * w) }
    @color(darker(steel, 0.35))
    solid bellows { folds = slats(neck.pipe, width: 2 * w, gap: 2.5 * w) }
    @color(darker(tin, 0.3))
    solid collar { v = trapezoid(bottom_width: 112 * w, top_width: 76 * w, height: 22 * w) }
    @color(brass) solid buttons { v = [circle((12 * w * i, 0), 3.4 * w) for i in -2..2] }
    @color(brass) solid right_ear {
        axle = rectangle(width: 6 * w, height: 12 * w)
        disc = rounded_rectangle(width: 7 * w, height: 32 * w, radius: 3 * w)
        knob = rounded_rectangle(width: 5 * w, height: 16 * w, radius: 2.4 * w)
        constrain row(axle, disc, knob, gap: 0, align: center)
    }
    left_ear = mirror(right_ear, about: y_axis)
    @color(tin)
    solid head { v = rounded_rectangle(center: origin, width: width, height: tall, radius: 14 * w) }
    @color(darker(tin, 0.22))
    solid shadow { v = difference(head.v, copy(head.v, by: (-5 * w, 4 * w))) }
    @color(lighter(tin, 0.35))
    solid plate { v = rounded_rectangle(width: 84 * w, height: tall - 14 * w, radius: 9 * w) }
    @color("#3a4a57")
    solid visor { v = rounded_rectangle((0, 0.14 * tall), 79 * w, 0.44 * tall, 12 * w) }
    @color(steel) solid studs {
        for i in 0..<rivets { left[i] = circle(center: (-37 * w, 10 * i), radius: 1.8 * w) }
    }
    right_studs = mirror(studs, about: y_axis)
    assembly lamp(d = 40) {
        let tones = [brass, "#22303c", "#4fe3d0"]
        for i, size in enumerate([1.18, 1, 0.68]) {
            @color(tones[i]) solid disc[i] { v = circle(center: origin, diameter: size * d) }
        }
        drawing rays { v = polar_array(line((0, 0), (0.08 * d, 0)), n: 24, radius: 0.25 * d) }
        @color("#0c3b44")
        solid pupil { v = cog(outer_radius: 0.22 * d, inner_radius: 0.16 * d, teeth: 8) }
        @color("white") solid glint { v = circle(center: (0.15 * d, 0.17 * d), radius: 0.07 * d) }
    }
    right_eye = lamp(d: min(eye, 0.34 * tallness) * width) at (20 * w, 14 * w)
    left_eye = mirror(right_eye, about: y_axis)
    @color(red) solid nose { v = triangle(center: (0, -5 * w), base: 9 * w, height: 8 * w) }
    @color("#22303c") solid features {
        mouth = rounded_rectangle(width: 52 * w, height: 15 * w, radius: 7.5 * w)
        brow = slot(start: (12 * w, 36 * w), end: (28 * w, 33 * w), width: 3.5 * w)
        other_brow = mirror(brow, about: y_axis)
    }
    @color("#f6efd8")
    solid grin { v = ribs(features.mouth, 52 * w / teeth, 42 * w / teeth, margin: 2.5 * w) }
    constrain {
        waves.origin == bulb.center
        buttons.center == collar.center
        column(bulb, antenna, head, neck, collar, gap: 0, align: center)
        plate.centered_in(head)
        visor.center == head.v.center + (0, 0.14 * tall)
        right_ear.right_of(head, gap: 0, align: center)
        right_eye.disc[0].v.center == head.v.center + (20 * w, 0.14 * tall)
        features.brow.bottom == right_eye.disc[0].top + 1.5 * w
        features.mouth.center == head.v.center - (0, 0.28 * tall)
        nose.v.center.y == head.v.center.y - 0.08 * tall
        spread(studs.left, inside: plate, axis: y, margin: 9 * w)
    }
}
