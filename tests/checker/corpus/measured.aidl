/// Measures in comparisons, as calls with a value, and with bounds.
// changes: arm, tube
drawing measured {
    wall = line(fixed((0, 0)), fixed((80, 0)))
    a    = circle(center: (20, 12), radius: 6)
    b    = circle(center: (55, 15), radius: 6)
    c    = rectangle(center: (90, 40), width: 10, height: 6)
    d    = circle(center: (10, 60), radius: 3)
    e    = circle(center: (14, 66), radius: 3)
    arm  = line(wall.start, length: 40, angle: 50deg)
    tip  = (60, 50)
    flag = line(fixed((0, 100)), length: 20, angle: guess(70deg))
    tube = slot(center: (0, 140), length: 30, width: 8)
    bow  = arc(center: (60, 140), radius: 20, start_angle: 0deg, end_angle: guess(60deg))
    disc = circle(center: (100, 140), radius: guess(10))
    pin  = point(92, 145)
    knob = point(110, 146)
    constrain {
        distance(a, wall) == 20
        distance(wall, b, 20)
        distance(b, a, 40)
        distance(c, b, at_least: 60)
        distance(d, e, at_most: 5)
        distance(d, wall, at_least: 50, at_most: 90)
        horizontal_distance(c, a, at_least: 80)
        horizontal_distance(d, e, at_most: 4)
        vertical_distance(c, wall.start) == 44
        vertical_distance(d, e, at_most: 6)
        angle(arm, wall) == 30deg
        angle(tip, wall.end, wall.start) == 100deg
        angle(wall.start, wall.end, tip, 100deg)
        angle(flag, 60deg)
        angle(flag) <= 61deg
        length(tube, 36)
        length(bow) == 30
        diameter(disc, 24)
        radius(disc) <= 12
        gap(a, c) >= 10
        pin == disc.edge_point(y: 145, side: left)
        flag.end.y <= edge_point(disc, x: 98).y
        distance(pin, knob, along: disc) == 20
        knob == disc.edge_point(along: 6)
    }
}
