/// A bracket that holds a rail to a fence post: a leg with two slots along the post, a foot with holes for the rail.
@thickness(4mm)
@material("stainless steel")
@title("Fence bracket")
@number("FB-01")
solid fence_bracket {
    param leg = 40mm in 30..60
    param reach = 120mm in 100..200
    param tall = 150mm in 120..250

    body = l_shape(center: (0, 0), width: reach, height: tall, thickness: leg)

    for i in 0..1 {
        hole track[i] { way = slot(center: (-40, 30 * i), length: 24, width: 9, angle: 90deg) }
    }
    for i in 0..1 {
        for j in 0..1 {
            hole screw[i][j] { rim = circle(center: (25 * i, 20 * j - 60), diameter: 5.5) }
        }
    }
    fillet(body.outline.corner[3], 8)

    constrain {
        track[0].center_x == body.bb.left + leg / 2
        track[1].center_x == track[0].center_x
        track[1].top == body.bb.top - 14
        vertical_distance(track[0].center, track[1].center) == 45
        screw[0][0].center == body.bb.bottom_left + (leg + 20, 10)
        screw[1][0].center == screw[0][0].center + (40, 0)
        screw[0][1].center == screw[0][0].center + (0, 20)
        screw[1][1].center == screw[0][0].center + (40, 20)
    }
}
