/// Screws, motors, bearings and bolt circles: sizes of standards, and the holes for them.
assembly standard_parts {
    param bolt = "m4" in ["m3", "m4", "m5"]
    let sizes = screw(bolt)
    solid plate {
        body = rounded_rectangle(width: 120, height: 80, radius: 6)
        motor = motor_mount(nema17, play: 0.5)
        for i in 0..3 { corner_hole[i] = screw_hole(bolt, fit: "close") at polar(30, 45deg + 90deg * i) }
        ring_ = bolt_circle(6, diameter: 50, size: bolt) at (3, 3)
        hole seat { rim = bearing_seat(608, center: (40, 0)) }
        hole trap { nut = hex_pocket("m5", center: (-45, 0)) }
        thread = tap_hole("m2.5") at (45, 30)
        constrain {
            motor.center == body.center
            ring_.center == body.center
            at_corners(corner_hole, body, inset: sizes.washer)
            seat.right == body.bb.right - bearing(608).width
            trap.left == body.bb.left + nema(23).pilot / 10
            thread.rim.diameter == screw("m2.5").tap
            corner_hole[0].rim.diameter == sizes.close
            motor.rim[1].center.x - motor.rim[0].center.x == nema17.bolts
            motor.pilot.diameter == nema("17").pilot + 0.5
            trap.nut.outline.radius >= screw(m5).nut / 2
        }
    }
    constrain plate.left == clearance_diameter(m3, fit: "loose")
    assert screws.m8.counterbore == 15
}
