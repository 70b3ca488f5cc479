/// Symmetry about lines, points and axes.
// changes: right_wing
solid butterfly {
    construction axis = line(origin, (1, 20))
    left_eye  = circle(center: (-4, 16), radius: 2)
    right_eye = circle(center: (5, 15), radius: 2)
    left_wing  = line((-3, 3), (-25, 20))
    right_wing = line((3, 2), (24, 21))
    a = (10, 0)
    b = (-9, 1)
    c = (3, -8)
    d = (-3, 9)
    constrain {
        vertical(axis)
        symmetric(right_eye, left_eye, about: axis)
        symmetric(right_wing, left_wing, about: axis)
        symmetric(a, b, about: y_axis)
        symmetric(c, d, about: origin)
        midpoint(origin, c, d)
    }
}
