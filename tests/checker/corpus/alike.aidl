/// Things of one size: curves, shapes of a kind, structures, and numbers.
// changes: c, flag.cloth, r
drawing alike {
    a = line((0, 0), length: guess(20), angle: 0deg)
    b = arc(center: (0, 30), radius: 20, start_angle: 0deg, end_angle: 60deg)
    c = circle(center: (60, 0), radius: 6)
    d = arc(center: (60, 30), radius: 9, start_angle: 0deg, end_angle: 90deg)
    e = ellipse(center: (100, 0), rx: guess(12), ry: guess(7))
    f = ellipse(center: (100, 30), rx: 14, ry: 5)
    r = rectangle(center: (140, 0), width: 12, height: 12)
    s = rectangle(center: (140, 30), width: 20, height: 10)
    t = slot(center: (180, 0), length: guess(20), width: guess(5))
    u = slot(center: (180, 30), length: 30, width: 8)
    h = regular_polygon(center: (220, 0), radius: guess(7), sides: 6)
    drawing flag { cloth = rectangle(center: (260, 0), width: 20, height: 10) }
    drawing towel { cloth = rectangle(center: (260, 30), width: 22, height: 11) }
    constrain {
        equal(a, b)
        equal(c, d)
        equal(e, f)
        equal(r, s)
        equal(t, u)
        equal(flag, towel)
        equal_radius(h, c, d)
        equal_length(a, b)
        equal(a.length, b.length)
    }
}
