/// An old-school telephone: a base, a receiver that lies on it, and a dial.
assembly telephone {
    /// Width of the base. It is fixed while solving; set it with `-D width=200`.
    param width = 160mm in 100..240

    solid base {
        body = trapezoid(center: (0, 0), bottom_width: width, top_width: 0.7 * width, height: 80)
    }

    @color("crimson")
    @detached
    solid receiver {
        grip = rectangle(center: (0, 70), width: 0.85 * width, height: 18)
        left_ear = circle(center: (-60, 62), radius: 16)
        right_ear = circle(center: (55, 60), radius: guess(15))  // a little off: constraints mend it
        constrain {
            equal(right_ear, left_ear)
            left_ear.center == grip.bottom_left + (16, 0)
            right_ear.center == grip.bottom_right - (16, 0)
        }
    }

    solid dial_plate {
        plate = circle(center: origin, radius: 28)
        for i in 0..9 {
            hole finger[i] {
                rim = circle(center: fixed(polar(19, 30deg * i + 60deg)), radius: 4)
            }
        }
    }

    constrain {
        receiver.above(base, gap: 2)
        centered_horizontally(receiver, base)
        dial_plate.centered_in(base)
        receiver.width <= base.width
    }

    assert receiver.bottom >= base.top, "the receiver lies on the base"
}
