/// A city tram in its street: doors and windows along the body, two bogies, a pantograph.
@stroke(0.4mm) @clip(scene.sky)
assembly tram {
    param length = 360 in 300..440
    param windows = 3 in 1..4
    param paint = "#a8323e"
    let cream = "#f0e4c8"
    let glass = "#d7e6ea"
    let pane_width = (length - 132) / (windows + 2) - 8

    @color("#a9c3cf") @shade(cream) @stroke(none) @rigid solid scene at fixed((0, 0)) {
        sky = rectangle((0, 85), length + 120, 250)
        @color("#8d8478") @shade("#5f574e")
        street = rectangle((0, -18), length + 120, 44)
        @color("#3d3833") rail = rectangle(top_center: (0, 0), width: length + 120, height: 3)
        @color("black") @opacity(0.6) @shade(fade)
        shadow = ellipse((0, -4), length / 2 + 30, 9)
    }
    @color("#2f3338") @rigid solid bogie(radius = 15) {
        frame = trapezoid(origin, 50, 76, 24)
        for i in 0..1 {
            tyre[i] = circle((48 * i - 24, -12), radius)
            @color("#9aa1a8") @shade(ball)
            hub[i] = circle((48 * i - 24, -12), 0.6 * radius)
        }
    }
    front = bogie() at (110, 0)
    rear = bogie() at (-110, 0)

    @color("#3d434a") solid pantograph {
        arms = thick(polyline([(-16, 0), (26, 24), (0, 48)]), 3)
        shoe = rounded_rectangle((0, 50), 56, 5, 2)
    }
    @color(paint) @shade(slope) @rigid solid body {
        hull = rounded_rectangle(origin, length, 92, 16)
        @color(cream) solid trim {
            band = rectangle((0, -17), length, 5)
            lamps = linear_array(circle(4), n: 2, pitch: length - 28, center: (0, -31))
            drawing lettering { name = text("CITY LINE 17", (0, -31), 9) }
        }
    }
    for i in 0..1 {
        @color(glass) @shade(darker(glass)) solid door[i] {
            leaf = rounded_rectangle(width: 40, height: 74, radius: 4)
        }
        constrain door[i].bottom == body.bottom + 6
    }
    for i in 0..windows + 1 {
        @color(glass) @shade(darker(glass)) @rigid solid pane[i] {
            window = rounded_rectangle(origin, pane_width, 36, 6)
            @color("white") @opacity(0.4) @stroke(none)
            gleam = parallelogram((-4, 0), 6, 36, 10)
        }
        constrain pane[i].top == body.top - 14
    }

    constrain {
        front.on_top_of(scene.rail)
        rear.on_top_of(scene.rail)
        row(rear, front, pitch: 0.6 * length)
        centered_horizontally([rear, front], scene)
        centered_horizontally(body, scene)
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
