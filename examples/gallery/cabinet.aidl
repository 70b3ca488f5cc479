/// A sideboard on tapered legs: rows of drawers over two panelled doors, a plant, books and a picture.
assembly cabinet {
    param width = 900mm in 675..1200
    param height = 720mm in 540..900
    param rows = 2 in 1..3 step 1
    param columns = 3 in 2..4 step 1
    param share = 0.45 in 0.33..0.6
    let wood = "#a8652f"
    let oak = "#c88a4b"
    let maple = "#dda867"
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
    @color(tint) @shade(slope)
    solid slab(tint = dark, w = 100, h = 100) { v = rounded_rectangle((0, 0), w, h, 4) }
    @color("#eef2e4") @shade("#bccab2")
    solid wall { v = rectangle((0, 65), 1.5 * width, height + 710) }
    @color("#c3d1b8") @stroke(none)
    solid paper { v = ribs(wall.v, pitch: 0.1 * width, width: 0.03 * width) }
    floor = slab("#a87c55", 1.5 * width, 180)
    @color("#7a5636") @stroke(2) drawing boards { v = planks(floor.v, width: 40, length: 300) }
    @color("#2b1d12") @opacity(0.3) @stroke(none) solid shadow {
        v = rectangle((40, -20), width, height)
        foot = ellipse((30, -height / 2 - 155), 0.6 * width, 40)
    }
    assembly picture at (0, height / 2 + 290) {
        shade = slab("#8a989a", 244, 204) at (8, -10)
        border = slab("#8f5c2a", 240, 200)
        @color("#f7d9a0") @shade("#7fb4cc", 90deg)
        solid evening { v = rectangle(width: 190, height: 150) }
        @color("#fff3c4") @stroke(none) solid sun { v = circle((-30, 0), 24) }
        @color("#5d8560") @shade(slope) solid hill { v = dome((0, -47), 190, 56) }
    }
    assembly plant {
        for i in 0..6 {
            @color("#6fa565") @shade("#3c6a3c", 0deg)
            solid leaf[i] at origin rotated 20 * i + 30 { v = lens((95, 0), 190, 56) }
        }
        @color("#b8623c") @shade(round) solid pot { v = trapezoid((0, -50), 84, 130, 120) }
    }
    assembly books {
        for i in 0..4 {
            @color(["#8a3333", "#46708e", "#c29a45"][i % 3]) @shade(round)
            solid book[i] { v = rectangle((38 * i, -12 * (i % 3)), 36, 190 - 24 * (i % 3)) }
        }
    }
    plate = slab(darker(wood, 0.2), width + 70, 26)
    @color(wood) @shade(slope)
    solid moulding { v = trapezoid(bottom_width: width, top_width: width + 40, height: 16) }
    case = slab(wood, width, height) at (0, 0)
    inside = slab(dark, inner + 2 * gap, height - post - gap)
    skirt = slab(darker(wood, 0.2), width, 32)
    @color(dark) @shade(round)
    solid right_leg at (width / 2 - 40, -500) { shaft = trapezoid((0, 0), 22, 44, 130) }
    left_leg = mirror(right_leg, about: y_axis)
    assembly drawer(w = 100mm, h = 80mm) {
        front = slab(oak, w, h)
        field = slab(maple, w - 24, h - 24)
        @color("#c28a4c") @stroke(2) drawing veins { v = wood_grain(field.v, pitch: 28) }
        @color(brass) @shade(ball) solid cup { v = dome(center: origin, width: 60, height: 24) }
    }
    for i in 0..<columns {
        for k in 0..<rows {
            let x = (cell_w + gap) * (i - (columns - 1) / 2)
            let y = height / 2 - post - cell_h / 2 - (cell_h + gap) * k
            drawers[i][k] = drawer(w: cell_w, h: cell_h) at (x, y)
        }
    }
    assembly door() {
        leaf = slab(oak, door_w, door_h)
        @color(darker(wood, 0.15)) @shade(slope)
        solid groove { v = arch(center: origin, width: door_w - 70, height: door_h - 60, rise: 30) }
        @color(maple) @shade(slope) solid panel { v = offset(groove.v, -10) }
        @color("#c28a4c") @stroke(2)
        drawing veins { v = wood_grain(panel.v, pitch: 34, angle: 90deg) }
        @color(brass) @shade(ball) solid knob { v = circle((18 - door_w / 2, 0), 11) }
        @color(brass)
        solid hinges { v = [rectangle((door_w / 2, k * door_h / 4), 16, 34) for k in [-1, 1]] }
    }
    right_door = door() at ((door_w + gap) / 2, post + door_h / 2 - height / 2)
    left_door = mirror(right_door, about: y_axis)
    constrain {
        column(plate, moulding, case, gap: 0, align: center)
        skirt.below(case, gap: 0, align: center)
        right_leg.below(skirt, gap: 0)
        inside.centered_in(case)
        plant.origin == plate.top_center + (-0.36 * width, 110)
        books.on_top_of(plate)
        books.right == plate.right - 70
        align_bottom(floor, wall)
    }
}
