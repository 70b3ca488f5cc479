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
    let porcelain = "#fdf9f0"
    let gold = "#dca832"
    @color(tint) @shade(round)
    solid bar(tint = gold, w = 40, h = 3) { v = rounded_rectangle((0, 0), w, h, 0.4 * h) }
    /// A flower of the band, with a leaf to either side.
    assembly flower(size = 8) {
        @color("#9cc9a0") @shade(slope)
        solid leaves { v = [lens((k * size, 0), 1.1 * size, 0.5 * size) for k in [-1, 1]] }
        @color("white") @shade("#d5dbe4", -50deg)
        solid petals { v = rosette(origin, size, inner_radius: 0.72 * size, lobes: 6, angle: 90) }
        @color("#f2b632") @shade(ball) solid eye { v = circle(origin, radius: 0.36 * size) }
    }

    @color("#efe7da") @shade("#cbbda6") @detached
    solid tray { v = ellipse((10 * w, -8), 96 * w, 15) }
    @color("#fffdf8") @opacity(0.6) drawing border { v = ellipse((10 * w, -7), 90 * w, 12.5) }
    @color("#4a3a28") @shade(fade) @opacity(0.8) @stroke(none)
    solid pool { v = ellipse((9 * w, -5.5), 66 * w, 9) }
    @color(glaze) @shade(ball) solid handle {
        way = path(
            (-36 * w, 76 * h),
            bezier_to((-58 * w, 108 * h), (-90 * w, 92 * h), (-84 * w, 58 * h)),
            bezier_to((-79 * w, 34 * h), (-60 * w, 24 * h), (-42 * w, 20 * h))
        )
        grip = thick(way, 10)
        thumb = circle((-62 * w, 95 * h), radius: 6)
        @color(gold) @stroke(1)
        drawing gilt { v = arc((-82 * w, 80 * h), (-72 * w, 35 * h), mid: (-84 * w, 58 * h)) }
    }
    @color(glaze) @shade(round, -25deg) solid spout {
        tube = path(
            (36 * w, 12 * h),
            bezier_to((66 * w, 14 * h), (50 * w + 0.4 * reach, 82 * h), (50 * w + reach, 102 * h)),
            line_by((-9, 6)),
            bezier_to((50 * w + 0.1 * reach, 104 * h), (56 * w, 74 * h), (38 * w, 66 * h)),
            close()
        )
    }
    @color(gold) @shade(round, -34deg) solid lip { edge = thick(line((0, 0), (-9, 6)), 4) }
    @color(porcelain) @shade(round) solid pot {
        body = path(
            (0, 0),
            right(26 * w),
            bezier_to((46 * w, 6 * h), (51 * w, 28 * h), (50 * w, 48 * h)),
            bezier_to((48.6 * w, 76 * h), (34 * w, 94 * h), (20 * w, 100 * h)),
            mirrored(about: y_axis)
        )
    }
    @color(glaze) @shade(round)
    solid band { field = clip(rectangle((0, 46 * h), 2 * width, 30 * h), by: pot.body) }
    @color(gold) @shade(round)
    solid rims { v = [clip(rectangle((0, y * h), 200 * w, 3 * h), pot.body) for y in [29, 63]] }
    garland = linear_array(flower(min(0.34 * pitch, 11 * h)), n: flowers, pitch: pitch)
    @clip(pot.body) @stroke(none) assembly gloss {
        @color("#3a2a20") @opacity(0.16) solid dark {
            side = difference(pot.body, copy(pot.body, by: (-9 * w, 0)))
            under = ellipse((2 * w, 99 * h), 24 * w, 5 * h)
        }
        @color("white") @opacity(0.6) solid light {
            flank = lens((-33 * w, 72 * h), 36 * h, 6 * w, angle: 48deg)
            spark = ellipse((-43 * w, 55 * h), 1.6 * w, 4 * h)
        }
    }
    foot = bar(glaze, 58 * w, 6)
    neck = bar(w: 44 * w, h: 4)
    @color(porcelain) @shade(round) solid lid { cap = dome(width: 40 * w, height: 15 * h) }
    collar = bar(w: 9 * w, h: 3)
    @color(glaze) @shade(ball) solid knob { ball = egg(width: 11 * w, height: 13 * w) }
    @color("#aebac4") @opacity(0.55) @stroke(none) @detached solid steam {
        wisp = [thick(wave((x, x / 4), (x + 4, 34 + x / 2), 3, 1.5), 2.2) for x in [0, 8, 16]]
    }
    constrain {
        column(knob, collar, lid.cap, neck, pot, foot, gap: -1, align: center)
        lip.center == spout.tube.segment[1].midpoint
        garland.center == (0, 46 * h)
        steam.above(lip, gap: 6)
        steam.center_x == lip.center_x
    }
}
