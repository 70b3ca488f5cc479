/// A brick house with a shingled roof, a smoking chimney, shuttered windows, a picket fence and a tree.
assembly house_with_chimney {
    param width = 124mm in 93..155
    param wall_height = 56mm in 42..70
    param roof_height = 44mm in 33..56
    param windows = 1 in 1..2 step 1
    param roof_color = "#9c4a3c" in ["#9c4a3c", "#5b6b7a", "#6f7f4f"]
    let bay = (width / 2 - 16) / windows
    let pane = min(18, 0.48 * bay)
    @color(tint) solid block(w = 10, h = 4, tint = "white") { v = rectangle((0, 0), w, h) }
    assembly window(w = pane, h = 0.44 * wall_height) {
        frame_ = block(w + 3, h + 3)
        glass = block(w, h, "#bfe0ee")
        drawing bars { v = [line((0, -h / 2), (0, h / 2)), line((-w / 2, 0), (w / 2, 0))] }
        @color("#3f7a5c") solid shutter {
            v = rectangle((0.73 * w + 1.5, 0), 0.38 * w, h + 3)
            drawing louvres { v = ribs(shutter.v, pitch: 3, width: 0, angle: 90, margin: 1) }
        }
        other_shutter = mirror(shutter, about: y_axis)
        box = block(1.5 * w, 4, "#8c5a33") at (0, -h / 2 - 3)
        @color("tomato") solid blossoms { v = [circle((k * w / 4, -h / 2), w / 9) for k in -2..2] }
    }
    sky = block(2.1 * width, wall_height + roof_height + 66, "#d5e8f2")
    @color("white") solid clouds { v = [ellipse((15 * i, 3 * (i % 2)), 14, 6) for i in 0..2] }
    @color("gold") @detached
    solid sun { v = star(origin, outer_radius: 15, inner_radius: 11, points: 14) }
    @color("#e4e8ec") solid smoke { puff = [circle((i * i, 6 * i), 3 + i) for i in 0..5] }
    @color("#79553a") solid trunk { v = trapezoid(bottom_width: 13, top_width: 8, height: 42) }
    @color("#5d9a4e")
    solid crown { v = rosette((0, 0), outer_radius: 26, inner_radius: 22, lobes: 11) }
    @color("tomato")
    solid apples { v = [circle(p, 2.6) for p in [(-11, 8), (8, 12), (13, -6), (-5, -9)]] }
    @color("#c97b5a")
    solid wall { face = rectangle(bottom_center: origin, width: width, height: wall_height) }
    @color("#b5654a") solid chimney { stack = rectangle((0, 0), 15, 34) }
    @color("#e7c3a5") drawing joints { v = [bricks(chimney.stack, 6, 3), bricks(wall.face, 10, 5)] }
    pot = block(19, 4, "#8c4a35")
    @color(roof_color) solid roof {
        slope = trapezoid((0, 0), width + 16, width - 26, roof_height)
        @color(darker(roof_color)) drawing cover { v = shingles(slope, width: 9, height: 6) }
    }
    @color("black") @opacity(0.3) solid eaves { v = rectangle((0, wall_height - 3), width, 7) }
    gutter = block(width + 18, 3)
    plinth = block(width + 6, 6, "#8b9096")
    for i in 0..<windows { right[i] = window() at (16 + (i + 0.5) * bay, 0.56 * wall_height) }
    left = mirror(right, about: y_axis)
    porch = block(34, 4, "#8b9096")
    frame_ = block(24, 37)
    @color("#2f5d7c") solid door {
        leaf = arch((0, 0), width: 19, height: 34)
        hole light { v = semicircle((0, 9), radius: 6.5) }
        drawing panels { v = grid(rectangle((-4.5, -10), 6, 9), 2, 2, pitch_x: 9, pitch_y: 11.5) }
    }
    @color("gold") solid knob { v = circle(radius: 1.2) }
    @color("#6aa84f")
    solid lawn { v = rounded_rectangle(width: 2.1 * width, height: 12, radius: 6) }
    @color("white") solid fence {
        for i in 0..4 { picket[i] = house((8 * i, 0), width: 5, height: 24, roof_height: 4) }
        rails = [rectangle((16, y), 42, 2.4) for y in [-6, 3]]
    }
    constrain {
        sky.on_top_of(lawn, align: center)
        clouds.top_right == sky.top_right - (12, 14)
        plinth.bottom == wall.face.bottom
        lawn.below(wall.face, gap: 0, align: center)
        gutter.stacked_on(wall.face)
        roof.slope.stacked_on(gutter)
        chimney.stack.bb.center == roof.slope.bb.center + (0.26 * width, 0.5 * roof_height)
        pot.stacked_on(chimney.stack)
        smoke.bottom_left == pot.top_left + (5, -1)
        porch.stacked_on(lawn)
        frame_.stacked_on(porch)
        door.leaf.bb.bottom == frame_.bottom
        door.leaf.center_x == frame_.center_x
        knob.center == door.leaf.bb.center + (7, -4)
        trunk.on_top_of(lawn)
        trunk.left == wall.face.right + 20
        crown.center == trunk.top_center + (0, 14)
        apples.center == crown.center
        fence.on_top_of(lawn)
        fence.right == plinth.left - 4
        sun.center == roof.slope.bb.top_left + (-10, 0)
    }
}
