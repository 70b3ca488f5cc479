/// A padlock, closed.
assembly padlock {
    param width = 60 in 45..80

    solid shackle {
        bow = thick(path(from: (-0.32 * width, 10), up(30), arc_to(to: (0.32 * width, 40), radius: 0.32 * width, clockwise: true), down(30)), 9)
    }
    solid body {
        case = rounded_rectangle(center: (0, -14), width: width, height: 52, radius: 6)
        hole keyhole { slot = rectangle(center: (0, -16), width: 5, height: 18) }
    }
}
