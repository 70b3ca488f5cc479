/// A city tram: doors and windows along its body, two bogies, a pantograph, and the track.
assembly tram {
    param length = 360 in 300..440
    param windows = 3 in 1..4
    param paint = "crimson"
    let pane_width = (length - 132) / (windows + 2) - 8

    @color("dimgray") solid track {
        rail = rectangle(width: length + 60, height: 5)
        for i in 0..10 { sleeper[i] = rectangle(width: 16, height: 6) }
        constrain {
            spread(sleeper, inside: rail, axis: x, margin: 10)
            for s in sleeper { s.top == rail.bottom }
        }
    }
    @color("black") @rigid solid bogie(radius = 15) {
        frame = trapezoid(center: origin, bottom_width: 50, top_width: 76, height: 24)
        for i in 0..1 {
            tyre[i] = circle(center: (48 * i - 24, -12), radius: radius)
            hole spokes[i] at (48 * i - 24, -12) {
                cut = polar_array(circle(radius: 2.5), n: 5, radius: 9)
            }
        }
    }
    front = bogie() at (110, 0)
    rear = bogie() at (-110, 0)

    @color(paint) @shade(slope) solid body {
        hull = rounded_rectangle(width: length, height: 92, radius: 16)
        @color("gold") drawing lettering { name = text("CITY LINE 17", height: 9) }
        constrain lettering.name.center == hull.bottom_center + (0, 14)
    }
    @color("dimgray") solid pantograph {
        arms = thick(polyline([(-16, 0), (26, 24), (0, 48)]), 3)
        shoe = rounded_rectangle(center: (0, 50), width: 56, height: 5, radius: 2)
    }
    for i in 0..1 {
        @color("lightcyan") @shade("lightblue") solid door[i] {
            leaf = rounded_rectangle(width: 40, height: 74, radius: 4)
        }
        constrain door[i].bottom == body.bottom + 6
    }
    for i in 0..windows + 1 {
        @color("lightcyan")
        solid pane[i] { glass = rounded_rectangle(width: pane_width, height: 36, radius: 6) }
        constrain pane[i].top == body.top - 14
    }

    constrain {
        front.on_top_of(track)
        rear.on_top_of(track)
        row(rear, front, pitch: 0.6 * length)
        centered_horizontally([rear, front], track)
        centered_horizontally(body, track)
        body.bottom == front.frame.bottom
        spread(
            [pane[0], door[0]] + [pane[i] for i in 1..windows] + [door[1], pane[-1]],
            inside: body,
            axis: x,
            margin: 14
        )
        pantograph.on_top_of(body, align: center)
    }
}
