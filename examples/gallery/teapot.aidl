/// A porcelain teapot with a painted band, gold rims, a lid, and steam over its curved spout.
assembly teapot {
    param width = 120mm in 90..150
    param height = 86mm in 64..108
    param flowers = 5 in 3..7 step 1
    param reach = 42mm in 31..53
    param glaze = "#3f7cac" in ["#3f7cac", "#b5483a", "#4f8a5b"]
    let w = width / 100
    let h = height / 100
    let pitch = 88 * w / flowers

    @color(tint)
    solid bar(tint = "goldenrod", w = 40, h = 3) { v = rounded_rectangle((0, 0), w, h, 0.4 * h) }
    /// A flower of the band, with a leaf to either side.
    assembly flower(size = 8) {
        @color("#8fb996")
        solid leaves { v = [lens((k * size, 0), 1.1 * size, 0.5 * size) for k in [-1, 1]] }
        @color("white")
        solid petals { v = rosette(origin, size, inner_radius: 0.72 * size, lobes: 6, angle: 90) }
        @color("gold") solid eye { v = circle(origin, radius: 0.36 * size) }
    }

    @color("#d8cfc0") @stroke(none) @detached solid cloth { v = ellipse((0, -5), 84 * w, 10) }
    @color(glaze) solid handle {
        way = path(
            (-36 * w, 76 * h),
            bezier_to((-58 * w, 108 * h), (-90 * w, 92 * h), (-84 * w, 58 * h)),
            bezier_to((-79 * w, 34 * h), (-60 * w, 24 * h), (-42 * w, 20 * h))
        )
        grip = thick(way, 9)
        thumb = circle((-62 * w, 95 * h), radius: 6)
        @color("goldenrod")
        drawing gilt { v = arc((-79 * w, 80 * h), (-70 * w, 35 * h), mid: (-82 * w, 56 * h)) }
    }
    @color(glaze) solid spout {
        tube = path(
            (36 * w, 12 * h),
            bezier_to((66 * w, 14 * h), (50 * w + 0.4 * reach, 82 * h), (50 * w + reach, 102 * h)),
            line_by((-9, 6)),
            bezier_to((50 * w + 0.1 * reach, 104 * h), (56 * w, 74 * h), (38 * w, 66 * h)),
            close()
        )
    }
    @color("goldenrod") solid lip { edge = thick(line((0, 0), (-9, 6)), 4) }
    @color("#fbf7ee") solid pot {
        body = path(
            (0, 0),
            right(26 * w),
            bezier_to((46 * w, 6 * h), (51 * w, 28 * h), (50 * w, 48 * h)),
            bezier_to((48.6 * w, 76 * h), (34 * w, 94 * h), (20 * w, 100 * h)),
            mirrored(about: y_axis)
        )
    }
    @color(glaze)
    solid band { field = clip(rectangle((0, 46 * h), 2 * width, 30 * h), by: pot.body) }
    @color("goldenrod")
    solid rims { v = [clip(rectangle((0, y * h), 200 * w, 3 * h), pot.body) for y in [29, 63]] }
    garland = linear_array(flower(min(0.34 * pitch, 11 * h)), n: flowers, pitch: pitch)
    @color(lighter(glaze, 0.6))
    drawing shine { v = arc((-20 * w, 91 * h), (-35 * w, 70 * h), mid: (-29 * w, 83 * h)) }
    @color("black") @opacity(0.18) @stroke(none) @detached
    solid shade { v = difference(pot.body, copy(pot.body, by: (-11 * w, 4 * h))) }
    foot = bar(glaze, 58 * w, 6)
    neck = bar("goldenrod", 44 * w, 4)
    @color("#fbf7ee") solid lid {
        cap = dome(width: 40 * w, height: 15 * h)
        drawing d { v = arc((-14 * w, 0), (-5 * w, 5 * h), mid: (-11 * w, 3.5 * h)) }
    }
    collar = bar("goldenrod", 9 * w, 3)
    @color(glaze) solid knob { ball = egg(width: 11 * w, height: 13 * w) }
    @color("lightslategray") @detached drawing steam {
        wisp = [wave((x, x / 4), (x + 4, 30 + x / 2), amplitude: 3, waves: 1.5) for x in [0, 8, 16]]
    }
    constrain {
        column(knob, collar, lid.cap, neck, pot, foot, gap: -1, align: center)
        lip.center == spout.tube.segment[1].midpoint
        garland.center == (0, 46 * h)
        steam.above(lip, gap: 6)
        steam.center_x == lip.center_x
    }
}
