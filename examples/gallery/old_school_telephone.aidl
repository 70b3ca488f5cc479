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
    let ink = "#2c2c33"
    @color(tint) @shade(light)
    solid roundel(tint = "gainsboro", radius = 20, light = "ball") { rim = circle(origin, radius) }
    @color(tint) @shade(light, way)
    solid bar(tint = ink, wide = 10, high = 4, light = "round", way = 90deg) {
        v = rounded_rectangle((0, 0), wide, high, min(wide, high) / 2.2)
    }
    @color("black") @shade(fade) @opacity(0.6) @stroke(none)
    solid pool { v = ellipse((4 * w, -6), 76 * w, 9 * w) }
    @color(ink) @shade(round, 60deg) solid cord {
        swing = arc((-50 * w, height + 2), (-45 * w, 6), mid: (-60 * w - 20, 42 * h))
        wire = thick(swing, 2)
        curls = along(slot((0, 0), 14, 3.8, 75deg), swing, n: curls_of_cord, inset: 4)
    }
    for i in 0..1 { feet[i] = bar(wide: 16 * w, high: 9) at ((72 * i - 36) * w, -2) }
    @color(tint) @shade(round) solid casing {
        outline = path(
            from: (0, 0),
            right(50 * w - 5),
            arc_by(90deg, radius: 5),
            up(4),
            bezier_to((46 * w, 30 * h), (34 * w, 42 * h), (31 * w, 84 * h)),
            bezier_to((30 * w, 95 * h), (28 * w, 100 * h), (24 * w, 100 * h)),
            mirrored(about: y_axis)
        )
    }
    /// The light and the shadows that lie on the casing.
    @clip(casing.outline) @stroke(none) assembly gloss {
        @color("black") @opacity(0.2) solid dark {
            under = ellipse((0, 100 * h), 50 * w, 12 * w)
            cast = circle((3 * w, 46 * h), 1.05 * r)
            skirt = rectangle((0, 0), 2 * width, 18)
        }
        @color("white") @opacity(0.4) solid light {
            sill = rectangle((0, 10), 2 * width, 1.6)
            flank = lens((-34 * w, 52 * h), 66 * h, 3 * w, angle: 74deg)
        }
    }
    /// The dial, about its own origin; the digits show through the holes of the wheel.
    assembly face {
        bezel = roundel("#d8dce0", r, "round")
        groove = roundel("#70757c", 0.94 * r, "slope")
        plate = roundel("ivory", 0.91 * r, "none")
        @color("black") drawing digits {
            for i in 0..9 { d[i] = text(str((i + 1) % 10), polar(0.67 * r, 60 + 26 * i), 0.12 * r) }
        }
        @color(ink) @shade(slope, -45deg) solid finger_wheel {
            plate = circle(center: origin, radius: 0.87 * r)
            for i in 0..9 { hole h[i] { rim = circle(polar(0.67 * r, 60 + 26 * i), 0.128 * r) } }
        }
        @color("white") @opacity(0.1) @stroke(none)
        solid sheen { v = [sector(origin, 0.87 * r, a, a + 35) for a in [115, 295]] }
        hub = roundel("#c9ced4", 0.4 * r)
        card = roundel("ivory", 0.31 * r, "none")
        drawing name { letters = text("AIDL", center: origin, width: 0.4 * r) }
        @color("silver") @shade(round, 60deg)
        solid stop { hook = strip(polar(0.97 * r, -34), polar(0.6 * r, -24), 0.14 * r, 0.09 * r) }
    }
    @color(darker(tint, 0.4)) @shade(round)
    solid saddle { block = trapezoid(bottom_width: 46 * w, top_width: 36 * w, height: 14) }
    @color(tint) @shade(round, 90deg) solid handset {
        body = path(
            from: (0, 14 * w),
            bezier_to((22 * w, 14 * w), (29 * w, 13 * w), (32 * w, 3 * w)),
            right(24 * w),
            bezier_to((59 * w, 19 * w), (50 * w, 28 * w), (34 * w, 28 * w)),
            bezier_to((23 * w, 28 * w), (12 * w, 26 * w), (0, 26 * w)),
            mirrored(about: y_axis)
        )
    }
    @color("white") @opacity(0.35) @stroke(none)
    solid gleam { v = [lens((k * 36 * w, 25 * w), 28 * w, 2 * w, -k * 9) for k in [-1, 1]] }
    for i in 0..1 { caps[i] = bar(darker(tint, 0.4), 28 * w, 5 * w, "round", 0deg) at (0, height) }
    @color(darker(tint, 0.2)) @shade(round, 20deg) solid horn {
        stem = tapered_slot((-16 * w, 0), (-18 * w, 12 * w), 4.5 * w, 3 * w)
    }
    other_horn = mirror(horn, about: y_axis)
    constrain {
        face.bezel.rim.center == casing.center + (0, 2)
        saddle.on_top_of(casing, align: center)
        handset.body.start == saddle.block.top.midpoint
        gleam.center == handset.center + (0, 9.5 * w)
        for i in 0..1 {
            caps[i].v.top_center == (handset.center_x + (88 * i - 44) * w, handset.bottom + 2)
        }
        horn.bottom == saddle.bottom + 2
    }
}
