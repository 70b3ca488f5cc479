/// A bracket that holds a stepper motor to a frame: the motor's holes above, slots for two screws below, so that the
/// motor can be moved to tighten a belt.
@thickness(4mm)
@material("aluminium")
solid motor_bracket {
    param motor = "nema17" in ["nema14", "nema17", "nema23"]
    param bolt = "m5" in ["m4", "m5", "m6"]  // what holds it to the frame
    param wall = 5mm in 4..10                // the least material around anything
    param travel = 8mm in 4..20              // how far the motor can be moved

    let flange = nema(motor)
    let sizes = screw(bolt)
    let side = flange.body + 2 * wall
    let foot = travel + sizes.washer + wall  // below the motor, so that its body leaves the washers free

    plate = rounded_rectangle(width: side, height: side + foot, radius: 4)
    mount = motor_mount(motor)

    for s in [-1, 1] {
        hole adjust[s] {
            track = slot(
                center: (15 * s, -30),
                length: travel + sizes.clearance,
                width: sizes.clearance,
                angle: fixed(90deg)
            )
        }
    }

    constrain {
        mount.center_x == plate.center.x
        mount.center_y == plate.bb.top - side / 2
        adjust[-1].left == plate.bb.left + wall + (sizes.washer - sizes.clearance) / 2
        adjust[1].right == plate.bb.right - wall - (sizes.washer - sizes.clearance) / 2
        adjust[-1].bottom == plate.bb.bottom + wall + (sizes.washer - sizes.clearance) / 2
        adjust[1].bottom == adjust[-1].bottom
    }

    let motor_bottom = mount.center_y - flange.body / 2
    assert adjust[1].top + (sizes.washer - sizes.clearance) / 2 <= motor_bottom,
        "a washer sits under the motor"
    assert adjust[1].left - adjust[-1].right >= wall, "the slots are too close to each other"
    assert clearance(mount, adjust[1]) >= wall, "the plate is weak between motor and slot"
}
