// Profiles: outlines of bars with right angles, about the centre of their box. The corners of each are
// `outline.corner[i]`, counter-clockwise, and its edges `outline.edge[i]`.

/// An L: a level and an upright bar that share the lower left corner.
///
/// ```aidl
/// solid bracket { body = l_shape(width: 40, height: 60, thickness: 8) }
/// ```
shape l_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert thickness < min(width, height), "the bars of this shape are thinner than it is long"
    outline = polygon(
        [
            place(0, 0),
            place(width, 0),
            place(width, thickness),
            place(thickness, thickness),
            place(thickness, height),
            place(0, height)
        ]
    )
    let bottom = outline.edge[0]
    let left = outline.edge[5]
}

/// A T: a level bar on top of the middle of an upright one.
///
/// ```aidl
/// solid hanger { body = t_shape(width: 60, height: 40, thickness: 8) }
/// ```
shape t_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert thickness < min(width, height), "the bars of this shape are thinner than it is long"
    outline = polygon(
        [
            place((width - thickness) / 2, 0),
            place((width + thickness) / 2, 0),
            place((width + thickness) / 2, height - thickness),
            place(width, height - thickness),
            place(width, height),
            place(0, height),
            place(0, height - thickness),
            place((width - thickness) / 2, height - thickness)
        ]
    )
    let bottom = outline.edge[0]
    let top = outline.edge[4]
}

/// A U: a level bar with an upright one at each end, open at the top.
///
/// ```aidl
/// solid clip { body = u_shape(width: 50, height: 30, thickness: 6) }
/// ```
shape u_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert 2 * thickness < width, "the uprights of a U are thinner than half of its width"
    assert thickness < height, "the bar of a U is thinner than it is high"
    outline = polygon(
        [
            place(0, 0),
            place(width, 0),
            place(width, height),
            place(width - thickness, height),
            place(width - thickness, thickness),
            place(thickness, thickness),
            place(thickness, height),
            place(0, height)
        ]
    )
    let bottom = outline.edge[0]
    let right = outline.edge[1]
    let left = outline.edge[7]
    let floor = outline.edge[4]
}

/// An H: two upright bars, joined in the middle by a level one.
///
/// ```aidl
/// solid coupling { body = h_shape(width: 40, height: 60, thickness: 10) }
/// ```
shape h_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert 2 * thickness < width, "the uprights of an H are thinner than half of its width"
    assert thickness < height, "the bar of an H is thinner than it is high"
    outline = polygon(
        [
            place(0, 0),
            place(thickness, 0),
            place(thickness, (height - thickness) / 2),
            place(width - thickness, (height - thickness) / 2),
            place(width - thickness, 0),
            place(width, 0),
            place(width, height),
            place(width - thickness, height),
            place(width - thickness, (height + thickness) / 2),
            place(thickness, (height + thickness) / 2),
            place(thickness, height),
            place(0, height)
        ]
    )
    let right = outline.edge[5]
    let left = outline.edge[11]
}

/// An I-beam: two level flanges, joined in the middle by an upright web.
///
/// Both have one `thickness`, or each its own: `flange` and `web`.
///
/// ```aidl
/// solid beam { body = i_shape(width: 40, height: 60, flange: 8, web: 5) }
/// ```
shape i_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    flange: length,
    web: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert min(flange, web) >= 0, "the flanges and the web of an I are not thinner than nothing"
    assert 2 * flange < height, "the flanges of an I are thinner than half of its height"
    assert web < width, "the web of an I is thinner than it is wide"
    outline = polygon(
        [
            place(0, 0),
            place(width, 0),
            place(width, flange),
            place((width + web) / 2, flange),
            place((width + web) / 2, height - flange),
            place(width, height - flange),
            place(width, height),
            place(0, height),
            place(0, height - flange),
            place((width - web) / 2, height - flange),
            place((width - web) / 2, flange),
            place(0, flange)
        ]
    )
    let bottom = outline.edge[0]
    let top = outline.edge[6]
}
fn i_shape(center: point = (0, 0), width: length, height: length, thickness: length) =
    i_shape(center, width, height, thickness, thickness)

/// A Z profile: an upright web with a flange to the left at the top and one to the right at the bottom.
///
/// Lies with its upper flange to the left.
///
/// ```aidl
/// solid purlin { body = z_shape(width: 50, height: 60, thickness: 8) }
/// ```
shape z_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert thickness < width and 2 * thickness < height,
        "the bars of a Z are thinner than it is long"
    outline = polygon(
        [
            place((width - thickness) / 2, 0),
            place(width, 0),
            place(width, thickness),
            place((width + thickness) / 2, thickness),
            place((width + thickness) / 2, height),
            place(0, height),
            place(0, height - thickness),
            place((width - thickness) / 2, height - thickness)
        ]
    )
    let bottom = outline.edge[0]
    let top = outline.edge[4]
}

/// A cross of two bars, about their common centre: equal ones of length `size`, or by `width` and `height`.
///
/// ```aidl
/// solid plus_sign { body = cross_shape(size: 40, width: 12) }
/// ```
shape cross_shape(
    center: point = (0, 0), size: length, width: length, angle: turn = 0deg, rotatable: bool = false
) {
    assert width < size, "the bars of a cross are longer than wide"
    outline = polygon(cross_corners(center, size / 2, size / 2, width / 2, angle))
}
shape cross_shape(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert thickness < min(width, height), "the bars of a cross are longer than wide"
    outline = polygon(cross_corners(center, width / 2, height / 2, thickness / 2, angle))
}

// The corners of a cross that reaches x and y from its centre; b is half the width of its bars.
fn cross_corners(center: point, x: length, y: length, b: length, angle: angle) = [center + turned(
    p, angle
) for p in [
    (b, b),
    (b, y),
    (-b, y),
    (-b, b),
    (-x, b),
    (-x, -b),
    (-b, -b),
    (-b, -y),
    (b, -y),
    (b, -b),
    (x, -b),
    (x, b)
]]

// `cross(a, b)` of two vectors is their product; with sizes it is the shape.
fn cross(center: point = (0, 0), size: length, width: length, angle: angle = 0deg) =
    cross_shape(center: center, size: size, width: width, angle: angle)
fn cross(
    center: point = (0, 0), width: length, height: length, thickness: length, angle: angle = 0deg
) = cross_shape(center: center, width: width, height: height, thickness: thickness, angle: angle)

/// A chevron that points to the right; `thickness` is measured level.
///
/// ```aidl
/// solid marker { body = chevron(width: 30, height: 40, thickness: 12) }
/// ```
shape chevron(
    center: point = (0, 0),
    width: length,
    height: length,
    thickness: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x - width / 2, y - height / 2), angle)
    assert thickness < width, "a chevron is thinner than wide"
    let tip = outline.corner[2]
    outline = polygon(
        [
            place(0, 0),
            place(thickness, 0),
            place(width, height / 2),
            place(thickness, height),
            place(0, height),
            place(width - thickness, height / 2)
        ]
    )
}

alias plus = cross_shape
alias plus_shape = cross_shape
alias l_profile = l_shape
alias angle_profile = l_shape
alias t_profile = t_shape
alias u_profile = u_shape
alias channel_profile = u_shape
alias h_profile = h_shape
alias i_profile = i_shape
alias i_beam = i_shape
alias z_profile = z_shape
