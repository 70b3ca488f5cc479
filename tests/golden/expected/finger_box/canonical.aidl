/// An open box with finger joints, laid out flat for a laser: a bottom, two walls with a name on one, two ends with
/// handles. Its sizes are those of the outside.
assembly finger_box {
    param length = 120mm in 60..200
    param depth = 80mm in 60..150
    param height = 50mm in 40..100
    param thickness = 3mm in 3..6
    param kerf = 0.15mm in 0..0.3  // the width of the laser's cut: tabs are drawn wider by it, so that they hold
    let apart = 5mm

    // Where three sheets meet, the corner belongs to the wall: all its edges begin with a tab.
    @thickness(thickness)
    @material("birch plywood")
    solid wall() {
        sheet = finger_panel(
            center: origin,
            width: length,
            height: height,
            thickness: thickness,
            edges: ["tabs", "tabs", "flat", "tabs"],
            kerf: kerf
        )
    }
    @thickness(thickness)
    @material("birch plywood")
    solid end() {
        sheet = finger_panel(
            center: origin,
            width: depth,
            height: height,
            thickness: thickness,
            edges: ["tabs", "notches", "flat", "notches"],
            kerf: kerf
        )
        hole handle {
            grip = slot(center: fixed((0mm, height / 2 - 15mm)), length: 0.4 * depth, width: 14)
        }
    }

    @detached
    @thickness(thickness)
    @material("birch plywood")
    solid bottom {
        sheet = finger_panel(
            center: origin,
            width: length,
            height: depth,
            thickness: thickness,
            edges: ["notches", "notches", "notches", "notches"],
            kerf: kerf
        )
    }
    @detached
    front = wall() at (0, -90)
    @detached
    back = wall() at (0, 90)
    @detached
    left = end() at (-130, 0)
    @detached
    right = end() at (130, 0)

    @layer("engrave")
    drawing label {
        name = text("SCREWS", width: 0.5 * length)
    }

    constrain {
        front.below(bottom, gap: apart)
        back.above(bottom, gap: apart)
        left.left_of(bottom, gap: apart)
        right.right_of(bottom, gap: apart)
        align_center_x(front, back, bottom)
        align_center_y(left, right, bottom)
        label.centered_in(front)
    }

    assert label.height <= 0.5 * front.height, "the name is too large"
    assert left.handle.top <= left.top - 6mm, "the handle is too close to the rim"
    assert left.handle.bottom >= left.bottom + thickness + 6mm,
        "the handle is too close to the bottom"
    if kerf == 0mm {
        // The sheets fill the box's walls once: no corner is missing, none is there twice.
        let hollow = (length - 2 * thickness) * (depth - 2 * thickness) * (height - thickness)
        let sheets = area(bottom) + area(front) + area(back) + 2 * (area(left) + area(left.handle))
        assert sheets * thickness == length * depth * height - hollow, "the joints do not fit"
    }
}
