/// A spur gear with mounting holes: involute teeth, a sunk web with lightening holes, bolts, a keyed bore.
assembly gear_with_holes {
    param teeth = 36 in 27..48 step 1
    param module = 4mm in 3..5
    param bolts = 6 in 4..8 step 2
    param lights = 6 in 4..8 step 1
    param bore = 0.16 in 0.12..0.2

    let r = teeth * module / 2
    let rim = r - 2.8 * module
    let hub = 0.46 * r
    let middle = (hub + rim) / 2
    let light = min(0.37 * (rim - hub), 2.1 * middle / lights)
    let bolt = 0.038 * r
    let shaft = bore * r
    let steel = "#8d99a6"
    let brass = "#d9a441"

    let s = 1.24 * r
    @color("#f3f7fa") solid sheet { v = rectangle((0, -0.06 * r), 2.6 * s, 2.6 * s) }
    @color("#c3d2de")
    drawing squares { v = crosshatch(sheet.v, pitch: 0.1 * s, angle: 0deg, margin: 0.08 * s) }
    @color("#33475c") drawing border {
        edge = rectangle((0, -0.06 * r), 2.44 * s, 2.44 * s)
        lines = [line((-1.16 * s * c, -1.16 * s * d), (1.16 * s * c, 1.16 * s * d)) for c, d in [
            [0, 1], [1, 0]
        ]]
        title = text("SPUR GEAR", start: (-1.16 * s, 1.05 * s), height: 0.07 * s)
        data = text(str(teeth) + " TEETH", start: (-1.16 * s, 0.96 * s), height: 0.05 * s)
    }
    @color("#5f7386") @opacity(0.5) solid shadow { v = circle((0.04 * r, -0.05 * r), r) }

    /// The openings go through all that lies on each other here.
    assembly blank {
        @color(steel)
        solid toothed { body = gear(teeth: teeth, module: module, center: origin, angle: 90deg) }
        @color(lighter(steel, 0.3))
        solid lip { v = ring(center: origin, outer_radius: rim + 0.9 * module, inner_radius: rim) }
        @color(darker(steel, 0.2)) solid web { v = circle(center: origin, radius: rim) }
        @color(lighter(steel, 0.15)) solid bosses {
            for i in 0..<lights {
                v[i] = circle(
                    center: polar(middle, 360deg / lights * i + 90deg), radius: 1.22 * light
                )
            }
        }
        @color(brass) solid flange { v = circle(center: origin, radius: hub) }
        @color(lighter(brass, 0.35)) solid chamfered {
            v = ring(center: origin, outer_radius: 0.96 * hub, inner_radius: 0.9 * hub)
        }
        @color(darker(brass, 0.2)) solid boss { v = circle(center: origin, radius: 1.32 * shaft) }
        hole lightening {
            for i in 0..<lights {
                v[i] = circle(center: polar(middle, 360deg / lights * i + 90deg), radius: light)
            }
        }
        hole mounting {
            for i in 0..<bolts {
                v[i] = circle(center: polar(0.67 * hub, 360deg / bolts * i), radius: bolt)
            }
        }
        hole axle {
            v = circle(center: origin, radius: shaft)
            keyway = rectangle(center: (0, shaft), width: 0.5 * shaft, height: 0.5 * shaft)
        }
    }

    /// A hexagon head on its washer.
    assembly bolt_head(size = 4mm) {
        @color("#e8ecef") solid washer { v = circle(center: origin, radius: 1.9 * size) }
        @color("#4c5663") solid head { v = hexagon(center: origin, radius: 1.55 * size) }
        @color("#6d7986") solid top { v = circle(center: origin, radius: 1.1 * size) }
    }
    for i in 0..<bolts step 2 {
        screws[i] = bolt_head(size: bolt) at polar(0.67 * hub, 360deg / bolts * i)
    }

    @color(darker(steel, 0.5)) drawing pitch_circle {
        v = circle(center: origin, radius: r - 1.9 * module)
    }
    @color("#c8312b")
    drawing mark { dot = circle(center: (0, r - 1.3 * module), radius: 0.3 * module) }
    assert clearance(blank.mounting, blank.axle) > 0, "the bolts clear the shaft"
}
