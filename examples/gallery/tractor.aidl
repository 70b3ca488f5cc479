/// A farm tractor running to the right: a great lugged wheel, a small one, a ribbed bonnet, a cab and a stack.
assembly tractor {
    /// Diameter of the rear wheel.
    param rear = 110mm in 95..130
    /// Diameter of the front wheel, as a share of the rear one.
    param front = 0.58 in 0.48..0.68
    /// From axle to axle.
    param wheelbase = 150mm in 140..180
    /// Lugs of the rear tyre.
    param lugs = 26 in 20..34 step 1
    /// Height of the cab.
    param cab = 82mm in 72..100

    let green = "#2f8f3e"
    let floor = 0.5 * rear + 4
    let nose = wheelbase + 22

    @color("#8a6b48")
    solid ground {
        soil = rectangle(left: -0.8 * rear, right: wheelbase + 80, bottom: -7, top: 1.2)
    }
    @color("#6b5136")
    drawing furrows { lines = hatching(ground.soil, pitch: 6) }
    @color("#4a4f57")
    solid stack at (wheelbase - 26, floor + 62) {
        pipe = rectangle(center: (0, 2), width: 6, height: 56)
        muffler = rounded_rectangle(center: (0, 0), width: 12, height: 24, radius: 4)
        flap = slot(center: (0, 31), length: 12, width: 3, angle: 25deg)
    }
    @color("#bfe3ee")
    solid glass {
        pane = trapezoid((0, floor + cab / 2 + 9), bottom_width: 86, top_width: 74, height: cab)
    }
    @color("#2b3138")
    solid interior {
        seat = slot(start: (-24, floor + 22), end: (-27, floor + 48), width: 9)
        wheel = strip((10, floor + 40), (26, floor + 51), 4)
        column = strip((34, floor + 14), (18, floor + 45), 3)
    }
    @color(darker(green, 0.25))
    solid pillars {
        bars = shell(glass.pane, 4.5)
        door = clip(rectangle(center: (8, floor + 40), width: 4, height: 2 * cab), by: glass.pane)
    }
    @color(green)
    solid roof {
        cap = rounded_rectangle(center: (2, floor + cab + 14), width: 92, height: 11, radius: 5)
    }
    @color("#f2b632")
    solid beacon { lamp = dome(width: 9, height: 9) }
    @color("#3a4048")
    solid chassis {
        frame = rectangle(left: -30, right: nose - 4, bottom: floor - 26, top: floor + 4)
    }
    @color(green)
    solid bonnet {
        hood = path(
            from: (40, floor),
            horizontal_to(nose),
            vertical_to(floor + 28),
            bezier_to((nose, floor + 40), (nose - 20, floor + 44), (40, floor + 48)),
            close()
        )
    }
    @color(darker(green, 0.35))
    solid louvres {
        construction field = rectangle(start: (66, floor + 12), end: (wheelbase - 34, floor + 36))
        slits = ribs(field, pitch: 7, width: 3)
    }
    @color("#f2d544")
    solid stripe {
        v = clip(rectangle(start: (40, floor + 2), end: (nose + 9, floor + 8)), by: bonnet.hood)
    }
    @color("#fff3b0")
    solid lamp { glass = ellipse(center: (nose - 5, floor + 24), rx: 4, ry: 7) }
    @color(green)
    solid mudguard {
        construction line_of_it = arc((0, rear / 2), rear / 2 + 10, 25deg, 150deg)
        v = thick(line_of_it, 9)
    }
    /// A tyre with lugs around discs that get smaller, and bolts round the hub.
    assembly big_wheel(d = 80mm, n = 24) {
        @color("#2a2c30")
        solid tyre { v = cog(outer_radius: 0.5 * d, inner_radius: 0.46 * d, teeth: n) }
        let tints = ["#43464c", "#f2c230", "#d09a1c", "#f2c230", "#5a5f66"]
        for i, r in enumerate([0.42, 0.3, 0.25, 0.13, 0.06]) {
            @color(tints[i])
            solid disc[i] { v = circle(center: origin, radius: r * d) }
        }
        @color("#6b5414")
        solid bolts { v = polar_array(circle(radius: 0.016 * d), n: 8, radius: 0.19 * d) }
    }
    rear_wheel = big_wheel(d: rear, n: lugs) at (0, rear / 2)
    front_wheel = big_wheel(d: front * rear, n: lugs - 4) at (wheelbase, 30)

    constrain {
        front_wheel.disc[0].v.center == fixed((wheelbase, front * rear / 2))
        beacon.on_top_of(roof, align: center)
    }
}
