/// A rotary telephone from the front: casing, finger wheel over its digits, handset in the cradle, curly cord.
assembly old_school_telephone {
    param width = 180mm in 135..225
    param height = 104mm in 78..130
    param dial = 0.8 in 0.6..1
    param curls_of_cord = 21 in 14..28 step 1
    param tint = "firebrick" in ["firebrick", "teal", "goldenrod", "darkslategray"]
    let w = width / 100
    let h = height / 100
    let r = dial / 2 * min(94 * h, 60 * w)
    let shadow = darker(tint, 0.4)
    @color(tint)
    solid roundel(tint = "gainsboro", radius = 20) { rim = circle(center: origin, radius: radius) }
    @color(tint) solid pads(tint = "#33333a", x = 10, width = 20, height = 10) {
        left = rounded_rectangle((-x, 0), width: width, height: height, radius: 0.4 * height)
        right = mirror(left, about: y_axis)
    }
    @color("#33333a") solid cord {
        let swing = arc((-48 * w, height), (-45 * w, 6), mid: (-60 * w - 20, 42 * h))
        wire = thick(swing, 2)
        for i in 0..<curls_of_cord {
            let turn = swing.start_angle + (i + 0.5) / curls_of_cord * swing.sweep
            curl[i] = slot(swing.center + polar(swing.radius, turn), 14, 3.6, angle: turn + 15deg)
        }
    }
    feet = pads(x: 36 * w, width: 15 * w) at (0, -3)
    @color(tint) solid casing {
        outline = path(
            from: (0, 0),
            right(50 * w - 5),
            arc_by(90deg, radius: 5),
            up(4),
            bezier_to((46 * w, 30 * h), (34 * w, 42 * h), (31 * w, 84 * h)),
            bezier_to((30 * w, 95 * h), (28 * w, 100 * h), (24 * w, 100 * h)),
            mirrored(about: y_axis)
        )
        @color(lighter(tint, 0.4))
        drawing shine { flank = arc((-42 * w, 25 * h), (-28 * w, 87 * h), mid: (-33 * w, 52 * h)) }
    }
    @color(shadow)
    solid skirt { rim = clip(rectangle(width: 2 * width, height: 20), by: casing.outline) }
    @color("black") @opacity(0.2) @stroke(none)
    solid shade { v = difference(casing.outline, copy(casing.outline, by: (-8 * w, 0))) }
    /// The dial, about its own origin; the digits show through the holes of the wheel.
    assembly face {
        bezel = roundel(radius: r)
        plate = roundel("ivory", radius: 0.92 * r)
        @color("black") drawing digits {
            for i in 0..9 { d[i] = text(str((i + 1) % 10), polar(0.67 * r, 60 + 26 * i), 0.12 * r) }
        }
        @color("#33333a") solid finger_wheel {
            plate = circle(center: origin, radius: 0.87 * r)
            for i in 0..9 { hole h[i] { rim = circle(polar(0.67 * r, 60 + 26 * i), 0.128 * r) } }
        }
        hub = roundel(radius: 0.38 * r)
        card = roundel("ivory", radius: 0.31 * r)
        drawing name { letters = text("AIDL", center: origin, width: 0.4 * r) }
        @color("silver")
        solid stop { hook = strip(polar(0.97 * r, -34), polar(0.6 * r, -24), 0.14 * r, 0.09 * r) }
    }
    @color(shadow)
    solid saddle { block = trapezoid(bottom_width: 46 * w, top_width: 36 * w, height: 14) }
    @color(tint) solid handset {
        body = path(
            from: (0, 14 * w),
            bezier_to((22 * w, 14 * w), (29 * w, 13 * w), (32 * w, 3 * w)),
            right(24 * w),
            bezier_to((59 * w, 19 * w), (50 * w, 28 * w), (34 * w, 28 * w)),
            bezier_to((23 * w, 28 * w), (12 * w, 26 * w), (0, 26 * w)),
            mirrored(about: y_axis)
        )
        @color(lighter(tint, 0.4))
        drawing shine { gleam = arc((-24 * w, 25 * w), (-51 * w, 17 * w), mid: (-39 * w, 25 * w)) }
    }
    @color("black") @opacity(0.2) @stroke(none)
    solid under { v = difference(handset.body, copy(handset.body, by: (0, 4 * w))) }
    caps = pads(shadow, x: 44 * w, width: 28 * w, height: 4.5 * w)
    @color(darker(tint, 0.2)) solid horns {
        left = tapered_slot((-16 * w, 0), (-18 * w, 12 * w), 4.5 * w, 3 * w)
        right = mirror(left, about: y_axis)
    }
    constrain {
        face.bezel.rim.center == casing.center + (0, 2)
        saddle.on_top_of(casing, align: center)
        handset.body.start == saddle.block.top.midpoint
        caps.top == handset.bottom + 2
        horns.bottom == saddle.bottom + 2
    }
}
