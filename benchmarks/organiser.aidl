/// A desk organiser: a tray with two bins, holes for pens, a slot for cards and a notch; a plate, a badge, a clip.
assembly organiser {
    param width = 180mm in 120..260
    param depth = 90mm in 70..140  // of the tray
    param pens = 4 in 2..6
    param wall = 4mm in 2..8
    let bin_width = (width - 5 * wall) / 2

    @detached
    solid tray {
        body = rounded_rectangle(width: width, height: depth, radius: 10)
        hole left {
            pocket = rounded_rectangle(center: (-40, -10), width: bin_width, height: 38, radius: 5)
        }
        hole right {
            pocket = rounded_rectangle((40, -10), width: bin_width, height: 38, radius: guess(4))
        }
        for i in 0..<pens {
            hole pen[i] {
                rim = circle(center: (15 * i - 30, 25), diameter: 11)
            }
        }
        hole cards {
            slit = slot(center: (0, 38), length: 70, width: 3)
        }
        hole notch {
            cut = rectangle(center: (60, 40), width: 12, height: 9)
            end = circle(center: (60, 35), radius: 6)
            constrain {
                end.center == cut.bottom.midpoint
                2 * end.radius == cut.width
            }
        }

        constrain {
            left.pocket.left == body.left + 2 * wall
            left.pocket.bottom == body.bottom + 2 * wall
            right.pocket.right == body.right - 2 * wall
            align_bottom(right, left)
            equal(right.pocket.corner_top_left, left.pocket.corner_top_left)
            pen[0].center_x == left.center_x
            pen[0].bottom == left.top + wall
            for i in 1..<pens {
                pen[i].right_of(pen[i - 1], gap: wall)
                pen[i].center_y == pen[0].center_y
            }
            cards.above(pen[0], gap: wall)
            cards.centered_horizontally(body)
            notch.top == body.top
            notch.right == right.right
        }
    }

    @detached
    solid plate {
        panel = rectangle(center: (0, -80), width: 80, height: 24)
        hole screws {
            left = circle(center: (-30, -80), diameter: 3.4)
            right = circle(center: (30, -80), diameter: 3.4)
        }
        constrain {
            screws.left.center == panel.left.midpoint + (6, 0)
            screws.right.center == panel.right.midpoint - (6, 0)
            panel.width <= 0.5 * width
        }
    }

    @detached
    solid badge {
        disc = circle(center: (70, -80), radius: 15)
        hole star_cut { sign = star(center: (70, -80), outer_radius: 9, inner_radius: 4) }
        constrain star_cut.sign.center == disc.center
    }

    @detached
    solid clip {
        arm = line((-70, -70), (-70, -95))
        bend = arc(center: (-62, -95), radius: 8, start_angle: 180deg, end_angle: 360deg)
        back = line(bend.end, (-54, -70))
        lid = line(back.end, arm.start)
        constrain {
            coincident(arm.end, bend.start)
            vertical(arm)
            parallel(arm, back)
            horizontal(lid)
            tangent(arm, bend)
            arm.length == 25
        }
    }

    constrain {
        plate.below(tray, gap: 8)
        plate.centered_horizontally(tray)
        badge.right_of(plate, at_least: 10)
        align_top(badge, plate)
        clip.left_of(plate, gap: 10)
        clip.top == plate.top
    }
    assert tray.cards.bottom >= tray.left.top, "the slot for cards meets a bin"
}
