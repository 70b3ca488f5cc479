/// An acoustic guitar, upright: a body of two bouts with a sound hole and a bridge, a neck, and a head with six pegs.
assembly acoustic_guitar {
    @color("burlywood")
    solid body {
        lower = circle(center: (0, 0), radius: 75)
        upper = circle(center: (0, 95), radius: 56)
        waist = rectangle(center: (0, 50), width: 100, height: 75)
        hole sound_hole { rim = circle(center: (0, 60), radius: 20) }
        constrain {
            vertical(lower.center, upper.center, sound_hole.rim.center, waist.center)
        }
    }
    @color("saddlebrown")
    solid bridge { bar = rounded_rectangle(width: 60, height: 8, radius: 3) }
    @color("saddlebrown")
    solid neck { board = rectangle(width: 18, height: 170) }
    @color("sienna")
    solid headstock {
        block = trapezoid(bottom_width: 22, top_width: 34, height: 50)
        for i in 0..2 {
            hole peg[i] {
                for s in [0, 1] {
                    axle[s] = circle(center: fixed((18 * s - 9, 12 * i - 12)), radius: 2)
                }
            }
        }
    }
    drawing strings {
        for i in 0..5 { string[i] = line(fixed((2.4 * i - 6, -25)), fixed((2.4 * i - 6, 270))) }
    }
    constrain {
        neck.bottom == body.upper.center.y
        neck.center_x == body.center_x
        headstock.stacked_on(neck)
        bridge.center_x == body.center_x
        bridge.center_y == body.lower.center.y - 20
        strings.center_x == body.center_x
        strings.bottom == bridge.center_y
    }
}
