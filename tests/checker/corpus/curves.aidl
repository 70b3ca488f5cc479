/// Arcs by every constructor, beziers and ellipses, and their boxes.
// changes: b
drawing curves {
    a = arc(center: (0, 0), start: (10, 0), end: (0, 10))
    b = arc(start: (20, 0), mid: (25, 5), end: (30, 0))
    c = arc(start: (40, 0), end: (50, 0), radius: 8)
    d = arc(center: (70, 0), radius: 8, start_angle: 200deg, end_angle: 340deg)
    e = arc(center: (90, 0), start: (90, 8), end: (98, 0), clockwise: true)
    f = bezier((0, 40), (10, 60), (20, 20), (30, 40))
    g = ellipse(center: (50, 40), rx: 12, ry: 5, angle: 30deg)
    h = arc(start: (60, 40), end: (70, 40), radius: 8, large: true)
    constrain {
        b.radius == 6
        a.bb.top == 12
        d.bottom == -9
        e.bb.right == a.bb.left + 100
        f.bb.top == 52
        g.left == 38
        h.sweep >= 180
        c.center.y == a.center.y - 3
    }
}
