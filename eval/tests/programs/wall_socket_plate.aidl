/// A plate with two sockets.
solid wall_socket_plate {
    param width = 80 in 70..100
    outline = rounded_rectangle(center: origin, width: width, height: 120, radius: 8)
    for i in 0..3 {
        hole slot[i] { cut = rectangle(center: fixed((14 * (2 * (i % 2) - 1), 60 * floor(i / 2) - 26)), width: 5, height: 16) }
    }
    for i in 0..1 {
        hole ground[i] { cut = circle(center: fixed((0, 60 * i - 44)), radius: 5) }
    }
    hole screw { cut = circle(center: fixed((0, 2)), radius: 3) }
}
