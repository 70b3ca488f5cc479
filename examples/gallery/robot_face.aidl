/// A friendly tin robot: lamps for eyes, a grin, ears, rivets, and an antenna with a bulb.
assembly robot_face {
    /// Width of the head.
    param width = 160mm in 130..210
    /// Height of the head, as a share of its width.
    param tallness = 0.85 in 0.75..1.05
    /// Diameter of an eye, as a share of the width of the head.
    param eye = 0.26 in 0.2..0.29
    /// Teeth that show in its grin.
    param teeth = 7 in 4..10 step 1
    /// Rivets along each side of the face plate.
    param rivets = 4 in 2..6 step 1

    let w = width / 100
    let tall = tallness * width
    let tin = "#8fb7c9"
    let steel = "#5b6470"
    let brass = "#e0b04c"
    let red = "#e5484d"

    @color(red)
    solid bulb { lamp = circle(radius: 6 * w) }
    @color(steel)
    solid antenna {
        foot = dome(width: 26 * w, height: 8 * w)
        rod = rectangle(width: 3 * w, height: 18 * w)
        for i in 0..2 { coil[i] = slot(length: 9 * w, width: 3 * w) }
        constrain {
            rod.stacked_on(foot)
            spread(coil, inside: rod, axis: y, margin: 2)
            for c in coil { centered_horizontally(c, rod) }
        }
    }
    @color(steel)
    solid neck { pipe = rectangle(width: 40 * w, height: 14 * w) }
    @color(darker(steel, 0.35))
    solid bellows { folds = slats(neck.pipe, width: 2 * w, gap: 2.5 * w) }
    @color(darker(tin, 0.3))
    solid collar { v = trapezoid(bottom_width: 70 * w, top_width: 52 * w, height: 8 * w) }

    @color(brass)
    solid right_ear {
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
    @color(steel)
    solid studs {
        for i in 0..<rivets { left[i] = circle(center: (-37 * w, 10 * i), radius: 1.8 * w) }
    }
    right_studs = mirror(studs, about: y_axis)

    /// A brass ring, a dark glass, a glowing iris with a cogwheel in it, and a glint.
    assembly lamp(d = 40) {
        let tones = [brass, "#22303c", "#4fe3d0"]
        for i, size in enumerate([1.18, 1, 0.68]) {
            @color(tones[i])
            solid disc[i] { v = circle(center: origin, diameter: size * d) }
        }
        @color("#0c3b44")
        solid pupil { v = cog(outer_radius: 0.22 * d, inner_radius: 0.16 * d, teeth: 8) }
        @color("white")
        solid glint { v = circle(center: (0.15 * d, 0.17 * d), radius: 0.07 * d) }
    }
    right_eye = lamp(d: eye * width) at (20 * w, 14 * w)
    left_eye = lamp(d: eye * width) at (-20 * w, 14 * w)

    @color(red)
    solid nose { v = triangle(center: (0, -5 * w), base: 9 * w, height: 8 * w) }
    @color("#22303c")
    solid features {
        mouth = rounded_rectangle(width: 52 * w, height: 15 * w, radius: 7.5 * w)
        brow = slot(start: (12 * w, 36 * w), end: (28 * w, 33 * w), width: 3.5 * w)
        other_brow = mirror(brow, about: y_axis)
    }
    @color("#f6efd8")
    solid grin { v = ribs(features.mouth, 52 * w / teeth, 42 * w / teeth, margin: 2.5 * w) }

    constrain {
        column(bulb, antenna, head, neck, collar, gap: 0, align: center)
        plate.centered_in(head)
        right_ear.right_of(head, gap: 0, align: center)
        left_eye.disc[0].v.center == head.v.center + (-20 * w, 0.14 * tall)
        right_eye.disc[0].v.center == head.v.center + (20 * w, 0.14 * tall)
        features.brow.bottom == right_eye.disc[0].top + 1.5 * w
        features.mouth.center == head.v.center - (0, 0.28 * tall)
        nose.v.center.y == head.v.center.y - 0.08 * tall
        spread(studs.left, inside: plate, axis: y, margin: 9 * w)
    }
}
