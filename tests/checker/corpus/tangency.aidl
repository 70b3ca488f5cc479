/// Tangency of lines, circles and arcs, with and without a shared end; concentric and equal circles.
// changes: e
drawing tangency {
    l = line((-20, 10), (40, 11))
    c = circle(center: (0, 0), radius: 9)
    d = circle(center: (30, 0), radius: guess(8))
    e = circle(center: (1, 1), radius: 3)
    f = circle(center: (3, 0), radius: guess(4))
    start = arc(center: (60, 0), start: (70, 0), end: (60, 10))
    next = line(start.end, (40, 12))
    after = arc(start: next.end, end: (30, 30), radius: 15)
    constrain {
        tangent(l, c)
        tangent(d, c)
        d.tangent(l)
        concentric(e, c)
        tangent(f, c, inside: true)
        tangent(start, next)
        tangent(next, after)
        radius(f, 4.5)
        diameter(e, 5)
    }
}
