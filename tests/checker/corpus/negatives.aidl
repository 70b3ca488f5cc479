/// Lines that begin with parentheses, powers, negative numbers, precedence.
solid signs {
    a = circle(center: (-3, -(2 + 1)), radius: 2 ^ 2)
    b = circle(center: (10, 5), radius: 2)
    constrain {
        (a.center.x + 3) * 2 == -2 ^ 2
        a.center.y == -7 % 4 - 2 ** 3 / 4
        b.center - a.center == (20, -1) * 0.5 + [1, 1] / 2
        norm(b.center - a.center) <= hypot(30, 40)
        dot(unit(b.center - a.center), (1, 0)) >= 0
    }
}
