/// Units, numbers of each dimension, and expressions over them.
solid units {
    param reach = 2.5cm in 10mm..5cm
    let share = 1 / 4
    let turn_part = 0.125turn
    a = rectangle(center: (0, 0), width: 1in, height: 0.1ft)
    b = circle(center: (60, 0), diameter: 2 * reach)
    c = line(origin, fixed(polar(30mm, turn_part)))
    constrain {
        a.width == 25.4mm
        a.height == 30.48
        b.radius == reach
        b.center.x - a.center.x == 2.4 * reach
        b.center.y - a.center.y == share * reach ^ 2 / 1mm
        c.angle == 45
        sin(c.angle) == cos(45deg)
    }
    assert abs(c.length - 30mm) <= 0.001mm, "the line is as long as it says"
}
