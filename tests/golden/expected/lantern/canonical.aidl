/// A storm lantern: a tank, a globe with a flame between two wires, a vented chimney, and a handle.
assembly lantern {
    param height = 240 in 180..300
    param vents = 4 in 2..6
    let w = 0.42 * height
    let tall = 0.38 * height

    @color("dimgray") @detached solid handle {
        construction way = arch(width: 1.12 * w, height: 1.1 * w)
        bow = thick([way.right, way.top, way.left], 5, caps: "butt")
    }

    @color("lightcyan") @shade(ball) solid globe {
        glass = path(
            from: (0, 0),
            line_to(0.26 * w, 0),
            smooth_to((0.46 * w, 0.4 * tall), heading: 90deg),
            smooth_to((0.24 * w, tall)),
            line_to(0, tall),
            mirrored()
        )
    }

    @color("orange") solid flame { tongue = drop(radius: 0.09 * w, height: 0.4 * w) }

    @color(darker("firebrick")) @shade(round)
    solid burner { cone = trapezoid(bottom_width: 0.5 * w, top_width: 0.2 * w, height: 0.12 * w) }

    @color("firebrick") @shade(round) solid tank {
        body = trapezoid(bottom_width: w, top_width: 0.75 * w, height: 0.16 * height)
        foot = rounded_rectangle(width: 1.1 * w, height: 10, radius: 4)
        constrain foot.top_center == body.bottom_center + (0, 4)

        @color("gold") drawing label { name = text("STORM", height: 0.12 * w) }
        constrain label.name.center == body.center
    }

    @color("firebrick") @shade(round) solid chimney {
        skirt = chamfered_rectangle(width: 0.66 * w, height: 12, chamfer: 3)
        pipe = rectangle(width: 0.44 * w, height: 0.14 * height)
        lid = dome(width: 0.62 * w, height: 0.06 * height)
        for i in 1..vents {
            hole vent[i] { slit = slot(length: 0.08 * height, width: 18 / vents, angle: 90deg) }
        }
        constrain {
            pipe.bottom_center == skirt.top_center
            lid.bottom_center == pipe.top_center
            spread(vent, inside: pipe, axis: x)
            align_center_y(vent, pipe)
        }
    }

    @color("dimgray") solid right_wire {
        way = path(
            from: (0.36 * w, 0),
            up(0.2 * w),
            line_to(0.56 * w, 0.4 * w),
            up(0.5 * w),
            line_to(0.3 * w, 1.2 * w)
        )
        rod = thick(way, 5, caps: "butt")
    }
    left_wire = mirror(right_wire, about: y_axis)

    constrain {
        burner.on_top_of(tank, align: center)
        globe.on_top_of(burner, align: center)
        chimney.on_top_of(globe, align: center)
        flame.bottom == burner.top
        flame.center_x == burner.center_x
        right_wire.way.corner[0].y == tank.body.top - 4
        handle.way.bottom == right_wire.way.corner[3].y
        centered_horizontally(handle.way, tank)
        tank.center_x == 0
    }
}
