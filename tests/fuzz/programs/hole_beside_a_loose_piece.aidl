/// A weather vane on a cupola: roof, pole, compass arms with letters, arrow with a tail, and a rooster on it.
assembly vane {
    param pole_height = 220 in 160..280
    param arrow_length = 200 in 150..240
    param arm_length = 130 in 100..160
    param rooster_size = 90 in 70..110
    let rod = 6

    @color("firebrick") solid roof {
        slope_side = triangle(bottom_center: (0, 0), base: 260, height: 90)
        @color(darker("firebrick")) drawing rows { tiles_on = shingles(slope_side, width: 18, height: 14) }
    }
    @color("whitesmoke") @shade(round) solid cupola {
        wall = rectangle(width: 180, height: 80)
        cornice = rectangle(width: 210, height: 10)
        constrain cornice.bottom_center == wall.top_center - (0, 5)
        for i in 0..2 {
            hole window[i] { pane = pointed_arch(width: 34, height: 56) }
        }
        constrain {
            spread(window, inside: wall, axis: x)
            align_center_y(window, wall)
        }
    }
    @color("dimgray") @behind(cupola) solid louvre_back {
        board = rectangle(width: 170, height: 70)
        @color("black") drawing louvres { lines = hatching(board, pitch: 6, angle: 0deg) }
    }

    @color("black") @behind(roof) solid pole {
        bar = strip((0, 150), (0, 370), start_width: 2 * rod, end_width: rod)
        constrain vertical(bar.start, bar.end)
        constrain distance(bar.start, bar.end) == pole_height
    }
    @color("goldenrod") @shade(ball) solid globe {
        ball = circle(radius: 14)
    }
    @color("goldenrod") @shade(ball) solid finial {
        ball = circle(radius: 9)
        spike = triangle(bottom_center: (0, 8), base: 7, height: 24)
        constrain spike.bottom_center == ball.center + (0, 7)
    }

    @color("black") solid cross {
        arm = strip((-65, 250), (65, 250), width: rod)
        hole pin { bore = circle(radius: 2) }
        constrain {
            horizontal(arm.start, arm.end)
            distance(arm.start, arm.end) == arm_length
            pin.bore.center == between(arm.start, arm.end)
        }
    }
    @color("goldenrod") solid west {
        plate = circle(radius: 14)
        hole letter { sign = text("W", height: 14, stencil: true) }
        constrain letter.sign.center == plate.center
    }
    @color("goldenrod") solid east {
        plate = circle(radius: 14)
        hole letter { sign = text("E", height: 14, stencil: true) }
        constrain letter.sign.center == plate.center
    }

    @color("black") solid pointer {
        shaft = strip((-100, 340), (100, 340), width: rod)
        head = triangle(a: (100, 354), b: (100, 326), c: (130, 340))
        tail = kite(width: 40, height: 50, shoulder: 18)
        construction middle = point(0, 340)
        constrain {
            horizontal(shaft.start, shaft.end)
            distance(shaft.start, shaft.end) == arrow_length
            head.ab.midpoint == shaft.end
            tail.center == shaft.start
            middle == between(shaft.start, shaft.end, share: 0.55)
        }
    }

    @color("darkgoldenrod") @shade(slope) solid rooster {
        body = path(
            from: (-0.5 * rooster_size, 0.5 * rooster_size),
            smooth_to((0, 0.15 * rooster_size), heading: 0deg, leaving: -80deg),
            smooth_to((0.4 * rooster_size, 0.7 * rooster_size), heading: 100deg),
            line_to(0.2 * rooster_size, 0.75 * rooster_size),
            smooth_to((-0.1 * rooster_size, 0.45 * rooster_size), heading: 200deg),
            close()
        )
        legs = rectangle(width: 8, height: 0.22 * rooster_size)
        comb = zigzag((0.2 * rooster_size, 0.8 * rooster_size), (0.4 * rooster_size, 0.72 * rooster_size), amplitude: 4, waves: 3)
        hole eye { bore = circle(center: (0.3 * rooster_size, 0.66 * rooster_size), radius: 2.5) }
        @color("black") drawing wing {
            curve = arc((-0.15 * rooster_size, 0.35 * rooster_size), (0.15 * rooster_size, 0.4 * rooster_size), radius: 0.2 * rooster_size)
        }
        constrain legs.top_center == body.bottom_center + (0, 4)
    }

    constrain {
        roof.slope_side.bottom == cupola.cornice.top
        roof.slope_side.center_x == cupola.center_x
        cupola.wall.bottom_center == (0, 0)
        louvre_back.board.center == cupola.wall.center
        pole.bar.start == roof.slope_side.apex - (0, 12)
        globe.ball.center == between(pole.bar.start, pole.bar.end, share: 0.15)
        cross.pin.bore.center == between(pole.bar.start, pole.bar.end, share: 0.4)
        west.plate.right == cross.arm.start.x
        west.plate.center.y == cross.arm.start.y
        east.plate.left == cross.arm.end.x
        east.plate.center.y == cross.arm.end.y
        pointer.middle == between(pole.bar.start, pole.bar.end, share: 0.8)
        finial.ball.center == pole.bar.end
        rooster.legs.bottom == pointer.shaft.top
        rooster.legs.center_x == pole.bar.end.x
    }
}
