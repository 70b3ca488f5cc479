/// A tractor from the side: a large rear wheel, a small front wheel, a hood, a cab and an exhaust.
assembly tractor {
    solid wheel(radius = 20) {
        tyre = circle(center: origin, radius: radius)
        hole rim { edge = ring(center: origin, outer_radius: 0.6 * radius, thickness: 2) }
    }
    @color("black")
    rear = wheel(radius: 40) at (0, 40)
    @color("black")
    front = wheel(radius: 22) at (110, 22)

    @color("forestgreen")
    solid body {
        hood = rectangle(center: (90, 60), width: 80, height: 30)
        seat_box = rectangle(center: (20, 55), width: 70, height: 40)
        constrain {
            hood.left == seat_box.right
            hood.bottom == seat_box.bottom
        }
    }
    @color("skyblue")
    solid cab {
        frame = trapezoid(bottom_width: 60, top_width: 48, height: 50)
    }
    @color("gray")
    solid exhaust { pipe = rectangle(width: 5, height: 25) }

    constrain {
        front.bottom == rear.bottom
        body.bottom == rear.tyre.center.y
        body.seat_box.left == rear.tyre.center.x - 10
        front.tyre.center.x == body.right - 15
        cab.bottom == body.seat_box.top
        cab.center_x == body.seat_box.center.x
        exhaust.bottom == body.hood.top
        exhaust.center_x == body.hood.center.x + 20
        front.tyre.center.y == 22
    }
}
