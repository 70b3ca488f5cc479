/// A mailbox on a wooden post, seen from the side: open door with letters, raised flag, flowers in the grass.
assembly mailbox {
    param width = 48mm in 36..60
    param height = 58mm in 43..73
    param depth = 76mm in 57..95
    param post_height = 96mm in 72..120
    param flowers = 4 in 2..6 step 1
    param paint = "#3b6ea5" in ["#3b6ea5", "#a63d40", "#4f7f4f"]
    let back = (depth, 0.28 * depth)
    let mouth = (-0.36 * depth, -0.22 * depth)
    let side = (width / 2, 0)
    /// The box from one share of its depth to another: what an arch passes over on its way back.
    @color(tint) @shade(slope, -75deg) solid tunnel(tint = paint, from = 0, to = 1, grow = 0) {
        let top = (0, height - width / 2)
        let foot = side + (grow, -grow)
        let ends = [from * back, to * back]
        v = hull(
            [circle(p + top, width / 2 + grow) for p in ends],
            [p + foot for p in ends],
            from * back + (-foot.x, foot.y)
        )
    }
    @color("white") @shade("#d9d4c6") solid letter(w = 0.62 * width, h = 0.4 * width) {
        paper = rectangle(origin, w, h)
        @color("slategray")
        drawing folds { v = polyline([(-w / 2, h / 2), (0, -1), (w / 2, h / 2)]) }
    }
    assembly flower(tall = 20, tint = "tomato") {
        @color("forestgreen") solid stalk {
            v = thick(arc((0, 0), (2, tall), mid: (-1, tall / 2)), 1.4)
            leaf = lens((3, 0.35 * tall), 9, 3.4, angle: 35)
        }
        @color(tint) @shade(ball)
        solid bloom { v = rosette((2, tall), outer_radius: 5, inner_radius: 3.8, lobes: 6) }
        @color("gold") @shade(ball) solid eye { v = circle((2, tall), radius: 1.8) }
    }
    @color("#8ec6ea") @shade("#f6f3e2") solid sky {
        v = rectangle(
            left: -64, right: depth + 50, bottom: -post_height - 22, top: height + back.y + 34
        )
    }
    @color("white") @shade("#d6e6f0") @stroke(none)
    solid cloud_ { v = cloud((depth + 8, height + back.y + 15), width: 54, height: 20) }
    @color("#7fb865") @shade("#4f8a3e") solid grass {
        v = rectangle(
            left: -64, right: depth + 50, bottom: -post_height - 22, top: 16 - post_height
        )
    }
    @color("#1f3d16") @shade(fade) @stroke(none)
    solid shadow { v = ellipse((0.42 * depth + 16, -post_height), 0.8 * depth, 7) }
    @color("#a87a4f") @shade(round) solid post {
        beam = rectangle(
            bottom_center: (0.42 * depth, -post_height), width: 18, height: post_height + 20
        )
        @color("#7a5431") drawing grain { v = wood_grain(beam, pitch: 3, angle: 90) }
    }
    @color("black") @shade(fade, -90deg) @opacity(0.5) @stroke(none) solid dusk {
        v = polygon([(0.42 * depth + x, y) for x, y in [[-9, 0], [-9, -18], [9, -13], [9, 0]]])
    }
    @color("#8a6039") @shade(slope) solid shelf {
        v = hull(
            [side + (-4, -3), back + side + (-4, -3), (-0.4 * width, -5), (0.4 * width, -5), back]
        )
    }
    back_rim = tunnel(lighter(paint), from: 0.93, grow: 1.4)
    body = tunnel(to: 0.93)
    front_rim = tunnel(lighter(paint), to: 0.08, grow: 1.4)
    @color("#3c4856") @shade("#0d1218")
    solid inside { v = arch(bottom_center: (0, 2), width: width - 6, height: height - 5) }
    for i in 0..1 {
        letters[i] = letter() at (3 - 5 * i, 0.52 * width - 8 * i) rotated 10deg - 14deg * i
    }
    @color(lighter(paint)) @shade(slope) solid door {
        v = path(-side, bezier_to(-side + 1.4 * mouth, side + 1.4 * mouth, side), close())
    }
    @color("crimson") @shade(slope) solid flag at side + 0.24 * back + (0, 0.4 * height) {
        pole = strip((0, 0), (0, 0.58 * height), 3)
        cloth = rectangle(top_left: (0, 0.58 * height), width: 18, height: 12)
    }
    @color("gold") @shade(ball) solid pivot { v = circle(radius: 3) }
    @color(lighter(paint, 0.4)) @stroke(none) solid rivets {
        v = [circle(side + k * back + (0, y * height), 1.2) for k in [0.13, 0.89] for y in [
            0.06, 0.3, 0.5
        ]]
    }
    @color("ivory")
    drawing number { v = text("42", height: 13, center: 0.6 * back + side + (-4, 0.2 * height)) }
    @color("#6fae54") @shade("#4f8a3e") @stroke(none) solid tuft {
        let foot = (0.42 * depth, -post_height - 4)
        v = path(foot + (-20, 0), zigzag_to(foot + (20, 0), 9, 11), close())
    }
    for i in 0..<flowers {
        plants[i] = flower(
            18 + 7 * (i % 3), ["tomato", "orchid", "white"][i % 3]
        ) at (0.42 * depth - 50 + 100 * i / (flowers - 1), -post_height)
    }
    constrain {
        pivot.center == flag.bottom_left + (1.5, 0)
    }
}
