/// One of each shape, arranged in columns.
// changes: a.s, k.s
assembly shapes {
    solid a { s = rounded_rectangle(width: 30, height: 20, radius: 4) }
    solid b { s = triangle(base: 20, height: 15) }
    solid c { s = triangle(a: (0, 0), b: (12, 1), c: (4, 9)) }
    solid d { s = parallelogram(width: 20, height: 10, shift: 5) }
    solid e { s = rhombus(width: 20, height: 14) }
    solid f { s = regular_polygon(radius: 10, sides: 5) }
    solid g { s = polygon([(0, 0), (10, 0), (12, 8), (4, 12)]) }
    drawing h { s = polyline([(0, 0), (10, 0), (12, 8), (4, 12)]) }
    solid i { s = star(outer_radius: 12, inner_radius: 5) }
    solid j { s = slot(length: 30, width: 8, angle: 30deg) }
    solid k { s = ring(outer_radius: 9, inner_radius: 5) }
    solid l { s = sector(radius: 12, start_angle: 20deg, end_angle: 110deg) }
    solid m { s = segment(radius: 12, start_angle: 20deg, end_angle: 160deg) }
    solid n { s = cross_shape(size: 20, width: 6) }
    solid o { s = slot(start: (0, 0), end: (20, 9), width: 6) }
    solid p { s = square(size: 11, angle: 15deg) }
    constrain {
        row(a, b, c, d, gap: 5, align: "bottom")
        row(e, f, g, h, gap: 5, align: "center")
        row(i, j, k, l, gap: 5, align: "top")
        row(m, n, o, p, gap: 5)
        column([a, e, i, m], gap: 8, align: "left")
        f.s.corner[0].y == e.s.center.y
        k.s.outer.radius == 10
        a.s.radius == 5
    }
}
