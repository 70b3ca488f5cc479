/// A brick house with a shingled roof, a smoking chimney, shuttered windows, a picket fence and a tree.
assembly house_with_chimney {
    param width = 124mm in 93..155
    param wall_height = 56mm in 42..70
    param roof_height = 44mm in 33..56
    param windows = 1 in 1..2 step 1
    param roof_color = "#9c4a3c" in ["#9c4a3c", "#5b6b7a", "#6f7f4f"]
    let bay = (width / 2 - 16) / windows
    let pane = min(18, 0.48 * bay)
    @color(tint) @shade(slope)
    solid block(w = 10, h = 4, tint = "white") { v = rectangle((0, 0), w, h) }
    assembly window(w = pane, h = 0.44 * wall_height) {
        frame_ = block(w + 3, h + 3)
        @color("#d9f0f8") @shade("#6fa3bd", -50deg) solid glass { v = rectangle(origin, w, h) }
        @color("white")
        drawing bars { v = [line((0, -h / 2), (0, h / 2)), line((-w / 2, 0), (w / 2, 0))] }
        @color("#3f7a5c") @shade(slope) solid shutter {
            v = rectangle((0.73 * w + 1.5, 0), 0.38 * w, h + 3)
            drawing louvres { v = ribs(shutter.v, pitch: 3, width: 0, angle: 0, margin: 1) }
        }
        other_shutter = mirror(shutter, about: y_axis)
        box = block(1.5 * w, 4, "#8c5a33") at (0, -h / 2 - 3)
        @color("tomato") solid blossoms { v = [circle((k * w / 4, -h / 2), w / 9) for k in -2..2] }
    }
    @color("#84bfe8") @shade("#f2f4ea")
    solid sky { v = rectangle(origin, width + 136, wall_height + roof_height + 66) }
    @color("white") @shade("#dfeaf2") @stroke(none)
    solid clouds { v = [ellipse((15 * i, 3 * (i % 2)), 14, 6) for i in 0..2] }
    @color("#ffe27a") @shade("#f7b733") @stroke(none) @detached
    solid sun { v = star(origin, outer_radius: 15, inner_radius: 11, points: 14) }
    @color("#f4f6f8") @shade("#aab3bd") @opacity(0.85) @stroke(none)
    solid smoke { puff = [circle((i * i, 6 * i), 3 + i) for i in 0..5] }
    lawn = block(width + 136, 34, "#7ab55c")
    @color("#2a4a1e") @opacity(0.35) @stroke(none) solid shadow {
        v = [ellipse((0.06 * width, -1), 0.56 * width, 6), ellipse((width / 2 + 32, -2), 28, 4)]
    }
    @color("#dccbaa") @shade(slope)
    solid way { v = trapezoid(bottom_width: 50, top_width: 26, height: 24) }
    @color("#79553a") @shade(round)
    solid trunk { v = trapezoid(bottom_width: 13, top_width: 8, height: 42) }
    @color("#5d9a4e") @shade(ball)
    solid crown { v = rosette((0, 0), outer_radius: 26, inner_radius: 22, lobes: 11) }
    @color("tomato")
    solid apples { v = [circle(p, 2.6) for p in [(-11, 8), (8, 12), (13, -6), (-5, -9)]] }
    @color("#c97b5a") @shade(slope, -60deg)
    solid wall { face = rectangle(bottom_center: origin, width: width, height: wall_height) }
    @color("#b5654a") @shade(slope, 0deg) solid chimney { stack = rectangle((0, 0), 15, 34) }
    @color("#e7c3a5") @stroke(0.5)
    drawing joints { v = [bricks(chimney.stack, 6, 3), bricks(wall.face, 10, 5)] }
    pot = block(19, 4, "#8c4a35")
    @color(roof_color) @shade(slope) solid roof {
        slope = trapezoid((0, 0), width + 16, width - 26, roof_height)
        @color(darker(roof_color)) @stroke(0.5)
        drawing cover { v = shingles(slope, width: 9, height: 6) }
    }
    @color("black") @shade(fade, -90deg) @opacity(0.7) @stroke(none)
    solid eaves { v = rectangle((0, wall_height - 3), width, 7) }
    gutter = block(width + 18, 3)
    plinth = block(width + 6, 6, "#8b9096")
    for i in 0..<windows { right[i] = window() at (16 + (i + 0.5) * bay, 0.56 * wall_height) }
    left = mirror(right, about: y_axis)
    porch = block(34, 4, "#8b9096")
    frame_ = block(24, 37)
    @color("#2f5d7c") @shade(slope) solid door {
        leaf = arch((0, 0), width: 19, height: 34)
        hole light { v = semicircle((0, 9), radius: 6.5) }
        drawing panels { v = grid(rectangle((-4.5, -10), 6, 9), 2, 2, pitch_x: 9, pitch_y: 11.5) }
    }
    @color("gold") @shade(ball) solid knob { v = circle(radius: 1.2) }
    @color("white") @shade(slope) solid fence {
        for i in 0..4 { picket[i] = house((8 * i, 0), width: 5, height: 24, roof_height: 4) }
        rails = [rectangle((16, y), 42, 2.4) for y in [-6, 3]]
    }
    constrain {
        sky.v.bottom == lawn.top - 6
        clouds.top_left == sky.top_left + (20, -14)
        plinth.bottom == wall.face.bottom
        lawn.top == wall.face.bottom + 10
        lawn.center_x == 0
        way.bottom == lawn.bottom
        gutter.stacked_on(wall.face)
        roof.slope.stacked_on(gutter)
        chimney.stack.bb.center == roof.slope.bb.center + (0.26 * width, 0.5 * roof_height)
        pot.stacked_on(chimney.stack)
        smoke.bottom_left == pot.top_left + (5, -1)
        porch.bottom == wall.face.bottom - 2
        frame_.stacked_on(porch)
        door.leaf.bb.bottom == frame_.bottom
        door.leaf.center_x == frame_.center_x
        knob.center == door.leaf.bb.center + (7, -4)
        trunk.bottom == wall.face.bottom - 4
        trunk.left == wall.face.right + 20
        crown.center == trunk.top_center + (0, 14)
        apples.center == crown.center
        fence.bottom == wall.face.bottom - 6
        fence.right == plinth.left - 4
        sun.center == roof.slope.bb.top_left + (-10, 0)
    }
}
