/// Turned structures: boxes are tight in the frame of the holder, points and directions are converted.
assembly mobile {
    solid bar at (0, 0) rotated 30deg {
        rod = rectangle(width: 50, height: 4)
        hole eye { rim = circle(center: (20, 0), radius: 1) }
    }
    solid moon rotated guess(10deg) {
        rim  = arc(center: (0, 0), radius: 10, start_angle: 30deg, end_angle: 330deg)
        edge = line(rim.end, rim.start)
    }
    solid leaf rotated 45deg at (5, 5) {
        upper = bezier((0, 0), (5, 12), (20, 10), (25, 0))
        lower = line(upper.end, upper.start)
    }
    solid base { foot = rectangle(width: 40, height: 5) }
    constrain {
        bar.above(base, gap: 3)
        moon.left_of(bar, gap: 2)
        moon.edge.angle == 100
        leaf.right_of(bar, gap: 1)
        leaf.upper.start.y == bar.rod.center.y
        bar.rod.bottom.angle == 30
    }
}
