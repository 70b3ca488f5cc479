/// A case for a Raspberry Pi 4, laser-cut from six panels of plywood with finger joints: openings for its ports, vents in
/// the lid, holes for the standoffs that it lies on. Every panel is seen from outside, but for the base. The width of
/// the cut is made up for by `--kerf`.
@thickness(thickness)
@material("birch plywood")
@title("Case for a Raspberry Pi 4")
assembly pi_case {
    param thickness = 3mm in 2..5
    param headroom = 20mm in 18..40  // over the board
    param vents = 9 in 3..11
    param title = "RASPBERRY PI"

    let board_length = 85mm
    let board_depth = 56mm
    let beside = 2mm  // between the board and the left and the front panel
    let standoff = 5mm
    let length = board_length + beside + 4mm + 2 * thickness  // the plugs stand out to the right
    let depth = board_depth + 2 * beside + 2 * thickness
    let height = standoff + 1.4mm + headroom + 2 * thickness

    // Where the board begins, from the middle of a panel, and where its upper side lies.
    let board_left = thickness + beside - length / 2
    let board_front = thickness + beside - depth / 2
    let deck = thickness + standoff + 1.4mm - height / 2
    let apart = 5mm

    @detached
    solid base {
        sheet = finger_panel(
            center: origin, width: length, height: depth, thickness: thickness, edges: ["notches"]
        )
        mount = raspberry_pi_mount() at fixed((board_left + 32.5mm, board_front + 28mm))
    }

    @detached
    solid lid {
        sheet = finger_panel(
            center: origin, width: length, height: depth, thickness: thickness, edges: ["notches"]
        )
        for i in 0..<vents {
            hole vent[i] {
                way = slot(
                    center: fixed((6mm * (i - (vents - 1) / 2), 8mm)),
                    length: 28,
                    width: 3,
                    angle: 90deg
                )
            }
        }
        drawing label { name = text(title, center: fixed((0mm, -18mm)), width: 0.6 * length) }
    }

    // Where three panels meet, the corner belongs to the front or the back: their edges begin with a tab.
    @detached
    solid front {
        sheet = finger_panel(
            center: origin, width: length, height: height, thickness: thickness, edges: ["tabs"]
        )
        hole power {
            way = rounded_rectangle(
                center: fixed((board_left + 11.2mm, deck + 1.6mm)),
                width: 12,
                height: 6,
                radius: 1.5
            )
        }
        for i in 0..1 {
            hole video[i] {
                way = rounded_rectangle(
                    center: fixed((board_left + 26mm + 13.5mm * i, deck + 1.6mm)),
                    width: 10,
                    height: 6,
                    radius: 1.5
                )
            }
        }
        hole sound { way = circle(center: fixed((board_left + 54mm, deck + 3mm)), diameter: 8) }
    }
    @detached
    solid back {
        sheet = finger_panel(
            center: origin, width: length, height: height, thickness: thickness, edges: ["tabs"]
        )
    }

    @detached
    solid right {
        sheet = finger_panel(
            center: origin,
            width: depth,
            height: height,
            thickness: thickness,
            edges: ["tabs", "notches"]
        )
        for i in 0..1 {
            hole usb[i] {
                way = rectangle(
                    center: fixed((board_front + 9mm + 18mm * i, deck + 8mm)), width: 15, height: 17
                )
            }
        }
        hole network {
            way = rectangle(
                center: fixed((board_front + 45.75mm, deck + 7mm)), width: 17, height: 15
            )
        }
    }
    @detached
    solid left {
        sheet = finger_panel(
            center: origin,
            width: depth,
            height: height,
            thickness: thickness,
            edges: ["tabs", "notches"]
        )
        hole card { way = slot(center: fixed((0mm, deck - 2.5mm)), length: 16, width: 4) }
    }

    constrain {
        front.below(base, gap: apart)
        back.above(base, gap: apart)
        lid.above(back, gap: apart)
        left.left_of(base, gap: apart)
        right.right_of(base, gap: apart)
        align_center_x(front, back, lid, base)
        align_center_y(left, right, base)
    }

    assert right.usb[1].right <= right.network.left - 0.5mm,
        "the openings for USB and the network run together"
    assert right.network.right <= right.right - thickness - 2mm,
        "the opening for the network cuts the joints"
    assert front.power.left >= front.left + thickness + 2mm, "the opening for power cuts the joints"
    assert lid.vent[vents - 1].right <= lid.right - thickness - 4mm,
        "the vents come too close to the joints"
    // The panels fill the walls of the case once: no corner is missing, none is there twice.
    let holes = area(base.mount) + 2 * area(right.usb[0]) + area(right.network) + area(left.card)
    let openings = area(front.power) + 2 * area(front.video[0]) + area(front.sound) + vents * area(
        lid.vent[0]
    )
    let panels = area(base) + area(lid) + area(front) + area(back) + area(left) + area(right)
    let hollow = (length - 2 * thickness) * (depth - 2 * thickness) * (height - 2 * thickness)
    assert (panels + holes + openings) * thickness == length * depth * height - hollow,
        "the joints do not fit"
}
