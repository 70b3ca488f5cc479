/// Clearances between outlines as hard constraints.
drawing rooms {
    pad  = rectangle(center: fixed((0, 0)), width: 30, height: 20, angle: fixed(30deg))
    ball = circle(center: (25, 10), radius: 5)
    rod  = line((30, -20), (45, -12))
    eye  = slot(start: (-40, 10), end: (-30, 25), width: 6)
    nut  = regular_polygon(center: (0, -35), radius: 8, sides: 6)
    card = rounded_rectangle(center: (60, 30), width: 20, height: 12, radius: 3)
    tip  = (5, 30)
    wedge_ = triangle(a: (-40, -30), b: (-20, -32), c: (-30, -15))
    constrain {
        clearance(ball, pad) == 4
        clearance(rod, ball) >= 6
        clearance(eye, pad) == 3
        clearance(nut, pad) == 2.5
        clearance(card, ball) == 7
        clearance(tip, pad) == 11
        clearance(wedge_, nut) >= 6
        clearance(wedge_, pad) == 5
        clearance(card, rod) <= 20
    }
    assert clearance(ball, pad) > 3.999
}
