/// Every relation of lines and points.
// changes: a, b, c, d, e
drawing lines {
    a = line((0, 0), (30, 2))
    b = line((0, 10), (31, 13))
    c = line((5, 20), (6, 40))
    d = line((50, 1), (70, -1))
    e = line((0, 50), (20, 58))
    f = line((2, 60), (20, 75))
    p = (12, 3)
    q = (40, 5)
    r = (70, 30)
    s = (90, 44)
    constrain {
        horizontal(a)
        parallel(b, a)
        perpendicular(c, a)
        collinear(d, a)
        equal_length(b, a)
        coincident(p, b)
        midpoint(q, d)
        distance(r, s) == 25
        horizontal_distance(r, s, 20)
        vertical_distance(a.start, r) == 35
        angle(e, f, 10deg)
        length(e, 22)
        distance(c, p) == 6
        collinear(r, s, c.end)
        d.dx == 21
    }
}
