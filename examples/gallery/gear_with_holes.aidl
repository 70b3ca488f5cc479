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
    let steel = "#93a1b0"
    let brass = "#dba63f"

    let s = 1.08 * r
    @color("#fbfcfd") @shade("#d5e2ec", -45deg)
    solid sheet { v = rectangle((0, -0.06 * r), 2.6 * s, 2.6 * s) }
    @color("#bccdda") @stroke(0.003 * s)
    drawing squares { v = crosshatch(sheet.v, pitch: 0.1 * s, angle: 0deg, margin: 0.08 * s) }
    @color("#33475c") drawing border {
        edge = rectangle((0, -0.06 * r), 2.44 * s, 2.44 * s)
        lines = [line((-1.16 * s * c, -1.16 * s * d), (1.16 * s * c, 1.16 * s * d)) for c, d in [
            [0, 1], [1, 0]
        ]]
        title = text("SPUR GEAR", start: (-1.16 * s, 1.05 * s), height: 0.07 * s)
        data = text(str(teeth) + " TEETH", start: (-1.16 * s, 0.96 * s), height: 0.05 * s)
    }
    for i in 0..2 {
        @color("#24364a") @opacity(0.22) @stroke(none)
        solid shadow[i] { v = circle((0.05 * r, -0.06 * r), (1.06 - 0.03 * i) * r) }
    }

    /// The openings go through all that lies on each other here.
    assembly blank {
        @color(steel) @shade(slope, -45deg)
        solid toothed { body = gear(teeth: teeth, module: module, center: origin, angle: 90deg) }
        @color(lighter(steel, 0.2)) @shade(slope, 135deg)
        solid lip { v = ring(center: origin, outer_radius: rim + 0.9 * module, inner_radius: rim) }
        @color(darker(steel, 0.15)) @shade(ball)
        solid web { v = circle(center: origin, radius: rim) }
        for i in 0..<lights {
            @color(lighter(steel, 0.2)) @shade(slope, -45deg) solid boss[i] {
                v = circle(center: polar(middle, 360deg / lights * i + 90deg), radius: 1.22 * light)
            }
        }
        @color(brass) @shade(slope, -45deg) solid flange { v = circle(center: origin, radius: hub) }
        @color(lighter(brass, 0.25)) @shade(slope, 135deg) solid chamfered {
            v = ring(center: origin, outer_radius: 0.97 * hub, inner_radius: 0.89 * hub)
        }
        @color(brass) @shade(ball) solid collar { v = circle(center: origin, radius: 1.32 * shaft) }
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
        @color("#d5dce2") @shade(slope, -45deg)
        solid washer { v = circle(center: origin, radius: 1.9 * size) }
        @color("#6a7684") @shade(slope, -45deg)
        solid head { v = hexagon(center: origin, radius: 1.55 * size) }
        @color("#8593a1") @shade(ball) solid top { v = circle(center: origin, radius: 1.1 * size) }
    }
    for i in 0..<bolts step 2 {
        screws[i] = bolt_head(size: bolt) at polar(0.67 * hub, 360deg / bolts * i)
    }

    @color(darker(steel, 0.5)) @stroke(0.004 * s) @dash(0.05 * s, 0.015 * s) drawing pitch_circle {
        v = circle(center: origin, radius: r - 1.9 * module)
    }
    @color("#c8312b")
    drawing mark { dot = circle(center: (0, r - 1.3 * module), radius: 0.3 * module) }
    assert clearance(blank.mounting, blank.axle) > 0, "the bolts clear the shaft"
}
