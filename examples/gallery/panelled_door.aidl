/// A front door: a panelled leaf with brasses under a fanlight, in a brick wall over stone steps.
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
    let paint = "#23705c"
    @color(tint) @shade(light)
    solid box(tint = "#f4f1e8", w = 10, h = 10, light = "slope") { v = rectangle(origin, w, h) }
    ground = box("#a9a193", 220 * u, 26 * u)
    wall = box("#b04a35", 220 * u, height + 100 * u)
    @color("#dcc3ab") @stroke(u)
    drawing mortar { v = bricks(wall.v, width: 26 * u, height: 10 * u) }
    @color("#e2dccb") @shade(round) solid surround {
        arch = arch(width: 140 * u, height: height + 78 * u)
        foot = rectangle(width: 146 * u, height: 18 * u)
    }
    @color("black") @opacity(0.35) @stroke(none) @behind(surround)
    solid cast { v = copy(surround.arch, by: (6 * u, 0)) }
    @color("#f4f1e8") @shade(slope)
    solid frame { v = arch(width: 116 * u, height: height + 64 * u) }
    @color("#d3cbb6") @shade(slope)
    solid keystone { v = trapezoid(bottom_width: 10 * u, top_width: 17 * u, height: 17 * u) }
    assembly fanlight {
        @color("#eaf6fa") @shade("#6fa6c4") solid glass { v = semicircle(radius: 48 * u) }
        @color("white") @opacity(0.4) @stroke(none) @clip(glass.v) solid glare {
            v = [parallelogram((x * u, 24 * u), 10 * u, 50 * u, 40 * u) for x in [-20, 6]]
        }
        @color("#f4f1e8") @shade(slope) solid sunburst {
            hub = semicircle(radius: 12 * u)
            curve = thick(arc(radius: 32 * u, start_angle: 0deg, end_angle: 180deg), 2.5 * u)
            for i in 1..<panes {
                let way = 180deg / panes * i
                ray[i] = strip(polar(8 * u, way), polar(49 * u, way), width: 2.5 * u)
            }
        }
    }
    transom = box(w: 106 * u, h: 7 * u)
    leaf = box(paint, width, height)
    /// A sunk panel: shade at its upper and left side, light at the others, and a raised field in it.
    assembly panel(w = 30mm, h = 60mm) {
        groove = box(darker(paint, 0.5), w, h, "none")
        @color(lighter(paint, 0.3)) @stroke(none)
        solid lit { v = polygon((-w / 2, -h / 2), (w / 2, -h / 2), (w / 2, h / 2)) }
        field = box(paint, w - 10 * u, h - 10 * u)
        rise = box(lighter(paint, 0.12), w - 20 * u, h - 20 * u)
    }
    for i in 0..<rows {
        let y = (i - (rows - 1) / 2) * (cell + 8 * u) + 4 * u
        for s in [-1, 1] { panels[i][s] = panel(34 * u, cell) at (21 * s * u, y) }
    }
    @color("black") @shade(fade, -90deg) @opacity(0.6) @stroke(none)
    solid reveal { v = rectangle(width: width, height: 6 * u) }
    @color("#dcae4a") @shade(slope) assembly brasses {
        let edge = -side * 44 * u
        solid plate { v = slot(center: (edge, rail), length: 22 * u, width: 7 * u, angle: 90deg) }
        solid letters { v = rounded_rectangle((0, rail), 26 * u, 7 * u, radius: u) }
        @shade(round) solid hinges {
            for i in -1..1 { v[i] = rectangle((side * 49 * u, i * height * 0.38), 5 * u, 13 * u) }
        }
        solid kick { v = rectangle((0, 7 * u - height / 2), 84 * u, 9 * u) }
        @shade(ball) solid knob { v = circle((edge, rail + 4 * u), radius: 5 * u) }
        drawing number { v = text("17", (0, height / 2 - 7 * u), height: 4.5 * u, bold: true) }
    }
    @color("#1d2b27") solid slits {
        lock = drop(center: (-side * 44 * u, rail - 6 * u), radius: 1.2 * u, height: 5 * u)
        mouth = slot(center: (0, rail), length: 20 * u, width: 2 * u)
    }
    steps = [box(stone, w * u, h * u) for stone, w, h in [
        ["#f0ebdd", 160, 3], ["#b9b1a0", 157, 8], ["#f0ebdd", 190, 3], ["#b9b1a0", 187, 8]
    ]]
    assembly planter() {
        for i, r in enumerate([17 * u, 14 * u, 11 * u]) {
            @color("#4f8f4b") @shade(ball)
            solid bush[i] { v = rosette((0, (34 + 21 * i) * u), r, 0.91 * r, lobes: 14) }
        }
        @color("#f2b84b") @shade(ball)
        solid fruit { v = [circle((5 * (-1) ^ i * u, (26 + 8 * i) * u), 1.8 * u) for i in 0..6] }
        @color("#c17a4b") @shade(round) solid pot {
            v = trapezoid((0, 10 * u), 20 * u, 27 * u, 20 * u)
            lip = rectangle((0, 21 * u), 32 * u, 5 * u)
        }
    }
    for k in [-1, 1] { planters[k] = planter() at (92 * k * u, -height) }
    constrain {
        align_center_x(surround.foot, surround.arch, keystone, frame, wall, leaf, reveal)
        column([fanlight, transom, leaf] + steps, gap: 0, align: center)
        for k in [-1, 1] { planters[k].origin == wall.v.bottom.midpoint + (92 * k * u, 0) }
        align_bottom(surround.foot, surround.arch, frame.v, wall, leaf)
        keystone.top == surround.arch.bb.top + 3 * u
        reveal.top == leaf.top
        ground.below(wall, gap: 0, align: center)
    }
}
