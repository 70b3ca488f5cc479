/// A sideboard on turned legs: rows of drawers over two panelled doors.
assembly cabinet {
    param width = 900mm in 675..1200
    param height = 720mm in 540..900
    param rows = 2 in 1..3 step 1
    param columns = 3 in 2..4 step 1
    param share = 0.45 in 0.33..0.6
    let wood = "#a3693a"
    let dark = darker(wood, 0.4)
    let brass = "#e3b750"
    let gap = 14mm
    let post = 36mm
    let inner = width - 2 * post
    let deep = share * height
    let cell_w = (inner - gap * (columns - 1)) / columns
    let cell_h = (deep - gap * rows) / rows
    let door_w = (inner - gap) / 2
    let door_h = height - deep - 2 * post
    @color(tint)
    solid slab(tint = dark, w = 100, h = 100) { v = rounded_rectangle((0, 0), w, h, 4) }
    wall = slab("#f2ead8", 1.5 * width, 1.9 * height + 160) at (0, 0.12 * height)
    @color("#dfd0b0") solid paper { v = ribs(wall.v, pitch: 0.1 * width, width: 0.04 * width) }
    floor = slab("#8a6444", 1.5 * width, 0.33 * height - 30)
    @color("#3b2a1e") @opacity(0.5) @stroke(none)
    solid shadow { v = ellipse((30, -height / 2 - 150), 0.56 * width, 34) }
    assembly plant {
        for i in 0..6 {
            @color("#5f8f58")
            solid leaf[i] at origin rotated 20 * i + 30 { v = lens((95, 0), 190, 56) }
        }
        @color("#b8623c") solid pot at origin { v = trapezoid((0, -50), 84, 130, 120) }
    }
    assembly books {
        let tones = ["#7a2e2e", "#46708e", "#c29a45"]
        for i in 0..4 {
            b[i] = slab(tones[i % 3], 36, 190 - 24 * (i % 3)) at (38 * i, -12 * (i % 3))
        }
    }
    plate = slab(darker(wood, 0.2), width + 70, 26)
    @color(wood)
    solid moulding { v = trapezoid(bottom_width: width, top_width: width + 40, height: 16) }
    case = slab(wood, width, height) at (0, 0)
    @color(darker(wood, 0.25))
    drawing grain { v = wood_grain(case.v, pitch: 70, angle: 90deg, margin: 4) }
    inside = slab(dark, inner + 2 * gap, height - post - gap)
    skirt = slab(darker(wood, 0.2), width, 32)
    @color(dark) solid leg() { shaft = trapezoid((0, 0), 22, 44, 130) }
    right_leg = leg() at (width / 2 - 40, -500)
    left_leg = leg() at (40 - width / 2, -500)
    assembly drawer(w = 100mm, h = 80mm) {
        @color(lighter(wood, 0.15))
        solid front { v = rectangle(center: origin, width: w, height: h) }
        @color(lighter(wood, 0.3)) solid field { v = rounded_rectangle(origin, w - 24, h - 24, 6) }
        @color(wood) drawing veins { v = wood_grain(field.v, pitch: 28) }
        @color(brass) solid cup { v = dome(center: origin, width: 60, height: 24) }
    }
    for i in 0..<columns {
        for k in 0..<rows {
            let x = (cell_w + gap) * (i - (columns - 1) / 2)
            let y = height / 2 - post - cell_h / 2 - (cell_h + gap) * k
            drawers[i][k] = drawer(w: cell_w, h: cell_h) at (x, y)
        }
    }
    assembly door() {
        @color(lighter(wood, 0.15))
        solid leaf { v = rectangle(center: origin, width: door_w, height: door_h) }
        @color(darker(wood, 0.15))
        solid groove { v = arch(center: origin, width: door_w - 70, height: door_h - 60, rise: 30) }
        @color(lighter(wood, 0.3)) solid panel { v = offset(groove.v, -10) }
        @color(wood) drawing veins { v = wood_grain(panel.v, pitch: 34, angle: 90deg) }
        @color(brass) solid brasses {
            knob = circle((18 - door_w / 2, 0), 11)
            for s in [-1, 1] { hinge[s] = square(center: (door_w / 2, s * door_h / 4), size: 24) }
        }
    }
    right_door = door() at ((door_w + gap) / 2, post + door_h / 2 - height / 2)
    left_door = mirror(right_door, about: y_axis)
    constrain {
        column(plate, moulding, case, gap: 0, align: center)
        skirt.below(case, gap: 0, align: center)
        right_leg.below(skirt, gap: 0)
        left_leg.below(skirt, gap: 0)
        inside.centered_in(case)
        plant.origin == plate.top_center + (-0.36 * width, 110)
        books.on_top_of(plate)
        books.right == plate.right - 70
        align_bottom(floor, wall)
    }
}
