/// An open umbrella.
assembly umbrella {
    param span = 200 in 160..240

    solid shaft { rod = rectangle(center: (0, -20), width: 6, height: 180) }
    solid handle {
        way = thick(path(from: (0, -105), down(20), arc_to(to: (30, -125), radius: 15)), 9)
    }
    solid canopy {
        cloth = dome(bottom_center: (0, 0), width: span, height: 0.4 * span)
        for i in 0..3 { hole scallop[i] { bite = circle(center: fixed((span * (i - 1.5) / 4, 0)), radius: span / 8) } }
    }
    solid tip { spike = rectangle(center: (0, 0.4 * span + 6), width: 5, height: 16) }
}
