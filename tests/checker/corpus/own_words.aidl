/// Functions, constraints, shapes and aliases that a program defines itself.
fn inset_point(corner: point, d: length) = corner + (d, d)
fn factorial(n: integer) = if n <= 1 then 1 else n * factorial(n - 1)
constraint hangs_from(a, b, drop: length = 10) {
    a.top == b.bottom - drop
    a.center_x == b.center_x
}
shape house(width = 30, height = 20, base: point = (0, 0)) {
    walls = rectangle(center: base + (0, height / 2), width: width, height: height)
    left_slope  = line(walls.top_left, walls.top.midpoint + (0, width / 3))
    right_slope = line(left_slope.end, walls.top_right)
    let peak = left_slope.end
}
alias dangles = hangs_from
alias dwelling = house

assembly village {
    solid hut { h = house(width: 24) }
    solid farm { h = dwelling(width: 40, height: factorial(4)) }
    solid sign { board = rectangle(width: 10, height: 6) }
    solid lamp { bulb = circle(radius: 2) }
    constrain {
        hut.left_of(farm, gap: 10)
        hut.h.peak.y == farm.h.walls.top
        sign.hangs_from(farm)
        dangles(lamp, sign, drop: 4)
        lamp.bulb.center.x == sign.center_x
    }
}
