/// A front door: a panelled leaf under a fanlight in a brick wall, with a knob, hinges and steps.
assembly panelled_door {
    param width = 900mm in 675..1125
    param height = 1950mm in 1460..2440
    param rows = 3 in 2..4 step 1
    param panes = 5 in 3..8 step 1
    param hinged = "left" in ["left", "right"]

    let u = width / 100
    let side = if hinged == "left" then -1 else 1
    let cell = (height - 20 * u) / rows - 8 * u
    let rail = (cell + 8 * u) * (1 - rows / 2) + 4 * u
    let paint = "#2f6b5a"
    let stone = "#e9e4d8"
    let brass = "#dcae4a"
    @color("#b5543c") solid wall { v = rectangle(width: 220 * u, height: height + 100 * u) }
    @color("#e6cdb6") drawing mortar { v = bricks(wall.v, width: 26 * u, height: 10 * u) }
    assembly planter() {
        @color("#5d8f56")
        solid shrub { v = [circle((0, (34 + 21 * i) * u), (17 - 3 * i) * u) for i in 0..2] }
        @color("#e6b34a")
        solid fruit { v = [circle((4 * (-1) ^ i * u, (28 + 9 * i) * u), 1.6 * u) for i in 0..5] }
        @color("#c98a5a") solid pot { v = trapezoid((0, 11 * u), 20 * u, 30 * u, 22 * u) }
    }
    for k in [-1, 1] { planters[k] = planter() at (92 * k * u, -height) }
    @color(stone) solid surround {
        arch = arch(width: 140 * u, height: height + 78 * u)
        foot = rectangle(width: 146 * u, height: 18 * u)
    }
    @color("#f7f5ee") solid frame { v = arch(width: 116 * u, height: height + 64 * u) }
    @color("#bfe0ea") solid glass { v = semicircle(radius: 48 * u) }
    @color("#f7f5ee") solid sunburst {
        hub = semicircle(radius: 12 * u)
        for i in 1..<panes {
            ray[i] = strip(origin, polar(49 * u, 180deg / panes * i), width: 2.5 * u)
        }
        curve = thick(arc(radius: 32 * u, start_angle: 0deg, end_angle: 180deg), 2.5 * u)
    }
    /// A sunk panel: its upper left side is in the shade, its lower right one in the light.
    assembly panel(w = 30mm, h = 60mm) {
        let b = 5 * u
        let x = w / 2
        let y = h / 2
        @color(lighter(paint, 0.3))
        solid groove { v = rectangle(center: origin, width: w, height: h) }
        @color(darker(paint, 0.45)) solid shade {
            v = polygon((-x, -y), (b - x, b - y), (x - b, y - b), (x, y), (-x, y))
        }
        @color(paint)
        solid field { v = rectangle(center: origin, width: w - 2 * b, height: h - 2 * b) }
    }
    @color("#f7f5ee") solid transom { v = rectangle(width: 106 * u, height: 6 * u) }
    @color(paint) solid leaf { v = rectangle(width: width, height: height) }
    for i in 0..<rows {
        for s in [-1, 1] {
            panels[i][s] = panel(
                w: 34 * u, h: cell
            ) at (s * 21 * u, (cell + 8 * u) * (i - (rows - 1) / 2) + 4 * u)
        }
    }
    @color(brass) solid brasses {
        plate = slot(center: (-side * 44 * u, rail), length: 22 * u, width: 7 * u, angle: 90deg)
        letters = rounded_rectangle(center: (0, rail), width: 26 * u, height: 6 * u, radius: u)
        for i in -1..1 {
            hinge[i] = rectangle(
                center: (side * 49 * u, i * height * 0.38), width: 5 * u, height: 13 * u
            )
        }
        kick = rectangle(center: (0, 7 * u - height / 2), width: 84 * u, height: 9 * u)
    }
    @color(lighter(brass, 0.35))
    solid knob { v = circle(center: (-side * 44 * u, rail + 4 * u), radius: 4.5 * u) }
    @color("#1d2b27") solid dark {
        lock = drop(center: (-side * 44 * u, rail - 6 * u), radius: 1.2 * u, height: 5 * u)
        slit = slot(center: (0, rail), length: 20 * u, width: 2 * u)
    }
    @color(darker(stone, 0.15)) solid upper_step { v = rectangle(width: 160 * u, height: 9 * u) }
    @color(darker(stone, 0.3)) solid lower_step { v = rectangle(width: 190 * u, height: 9 * u) }
    constrain {
        align_center_x(surround.foot, surround.arch, frame, wall, leaf)
        column(glass, transom, leaf, upper_step, lower_step, gap: 0, align: center)
        sunburst.hub.bb.bottom_center == glass.v.bb.bottom_center
        for k in [-1, 1] { planters[k].origin == wall.v.bottom.midpoint + (92 * k * u, 0) }
        align_bottom(surround.foot, surround.arch, frame.v, wall, leaf)
    }
}
