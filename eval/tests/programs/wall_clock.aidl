/// A wall clock: a rim, a dial with twelve marks, and two hands from the centre.
assembly wall_clock {
    param radius = 100 in 60..150

    @color("saddlebrown")
    solid rim { band = ring(outer_radius: radius, thickness: 8) }

    @color("ivory")
    solid face { disc = circle(radius: radius - 8) }

    @color("black")
    solid marks {
        for i in 0..11 {
            mark[i] = slot(
                start: fixed(polar(radius - 24, 30deg * i)),
                end: fixed(polar(radius - 16, 30deg * i)),
                width: 3
            )
        }
    }

    @color("black")
    solid hour_hand rotated 150deg {
        blade = slot(start: origin, end: (45, 0), width: 5)
    }

    @color("black")
    solid minute_hand rotated 60deg {
        blade = slot(start: origin, end: (68, 0), width: 3)
    }

    constrain {
        face.centered_in(rim)
        marks.centered_in(face)
        hour_hand.blade.start == face.disc.center
        minute_hand.blade.start == face.disc.center
    }
}
