// Figures with four corners.

/// A trapezoid: two level sides, symmetric about its vertical axis.
///
/// By its two widths and its height, or with the angle of its legs to the bottom side; by its centre or the middle of
/// its bottom or top side.
///
/// ```aidl
/// solid foot { body = trapezoid(bottom_width: 60, top_width: 40, height: 25) }
/// ```
shape trapezoid(
    center: point = (0, 0),
    bottom_width: length,
    top_width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    bottom_left = center + turned((-bottom_width / 2, -height / 2), angle)
    bottom_right = center + turned((bottom_width / 2, -height / 2), angle)
    top_right = center + turned((top_width / 2, height / 2), angle)
    top_left = center + turned((-top_width / 2, height / 2), angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}
shape trapezoid(
    center: point = (0, 0),
    bottom_width: length,
    height: length,
    leg_angle: angle,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    let top_width = bottom_width - 2 * height / tan(leg_angle)
    bottom_left = center + turned((-bottom_width / 2, -height / 2), angle)
    bottom_right = center + turned((bottom_width / 2, -height / 2), angle)
    top_right = center + turned((top_width / 2, height / 2), angle)
    top_left = center + turned((-top_width / 2, height / 2), angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
    assert top_width >= 0, "the legs of this trapezoid meet below its top"
}

/// By the middle of its bottom or top side, about which it turns.
fn trapezoid(
    bottom_center: point,
    bottom_width: length,
    top_width: length,
    height: length,
    angle = 0deg,
    rotatable = false
) = trapezoid(bottom_center, -1, bottom_width, top_width, height, angle, rotatable)
fn trapezoid(
    top_center: point,
    bottom_width: length,
    top_width: length,
    height: length,
    angle = 0deg,
    rotatable = false
) = trapezoid(top_center, 1, bottom_width, top_width, height, angle, rotatable)

// By the middle of a level side: `up` is -1 for the bottom, 1 for the top.
shape trapezoid(
    anchor: point,
    up: integer,
    bottom_width: length,
    top_width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x: length, y: integer) = anchor + turned((x, (y - up) * height / 2), angle)
    center = place(0, 0)
    bottom_left = place(-bottom_width / 2, -1)
    bottom_right = place(bottom_width / 2, -1)
    top_right = place(top_width / 2, 1)
    top_left = place(-top_width / 2, 1)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

/// A trapezoid whose left side is upright, by its lower left corner.
///
/// Lies with the upright side on the left, held at `bottom_left`.
///
/// ```aidl
/// solid ramp { body = right_trapezoid(bottom_width: 60, top_width: 35, height: 20) }
/// ```
shape right_trapezoid(
    bottom_left: point = (0, 0),
    bottom_width: length,
    top_width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    bottom_right = bottom_left + polar(bottom_width, angle)
    top_left = bottom_left + polar(height, angle + 90deg)
    top_right = top_left + polar(top_width, angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

/// A parallelogram with level sides, the upper one shifted to the right by `shift`.
///
/// Or by its two sides and the angle between them, at the lower left corner.
///
/// ```aidl
/// solid blade { body = parallelogram(width: 40, height: 20, shift: 12) }
/// ```
shape parallelogram(
    center: point = (0, 0),
    width: length,
    height: length,
    shift: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    bottom_left = center + turned((-(width + shift) / 2, -height / 2), angle)
    bottom_right = bottom_left + polar(width, angle)
    top_right = bottom_right + turned((shift, height), angle)
    top_left = bottom_left + turned((shift, height), angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}
shape parallelogram(
    center: point = (0, 0),
    width: length,
    side: length,
    side_angle: angle,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert 0deg < side_angle < 180deg, "the angles of a parallelogram are between 0 and 180 degrees"
    bottom_left = center - (polar(width, angle) + polar(side, angle + side_angle)) / 2
    bottom_right = bottom_left + polar(width, angle)
    top_left = bottom_left + polar(side, angle + side_angle)
    top_right = bottom_right + top_left - bottom_left
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

/// A rhombus by its two diagonals, or by its side and the angle between its sides on the right and left.
///
/// Its corners are `right_corner`, `top_corner`, `left_corner` and `bottom_corner`; `edges` begin on the right.
///
/// ```aidl
/// solid tile { body = rhombus(width: 40, height: 24) }
/// ```
shape rhombus(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    right_corner = center + polar(width / 2, angle)
    top_corner = center + polar(height / 2, angle + 90deg)
    left_corner = center - polar(width / 2, angle)
    bottom_corner = center - polar(height / 2, angle + 90deg)
    edges[0] = line(right_corner, top_corner)
    edges[1] = line(top_corner, left_corner)
    edges[2] = line(left_corner, bottom_corner)
    edges[3] = line(bottom_corner, right_corner)
    let edge = edges
    let corner = [right_corner, top_corner, left_corner, bottom_corner]
    let corners = corner
}
shape rhombus(
    center: point = (0, 0),
    side: length,
    side_angle: angle,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert 0deg < side_angle < 180deg, "the angles of a rhombus are between 0 and 180 degrees"
    right_corner = center + polar(side * cos(side_angle / 2), angle)
    top_corner = center + polar(side * sin(side_angle / 2), angle + 90deg)
    left_corner = center - polar(side * cos(side_angle / 2), angle)
    bottom_corner = center - polar(side * sin(side_angle / 2), angle + 90deg)
    edges[0] = line(right_corner, top_corner)
    edges[1] = line(top_corner, left_corner)
    edges[2] = line(left_corner, bottom_corner)
    edges[3] = line(bottom_corner, right_corner)
    let edge = edges
    let corner = [right_corner, top_corner, left_corner, bottom_corner]
    let corners = corner
}
// By its lower or upper corner, about which it turns.
fn rhombus(bottom_corner: point, width: length, height: length, angle: angle = 0deg) = rhombus(
    center: above_foot(bottom_corner, height, angle), width: width, height: height, angle: angle
)
fn rhombus(top_corner: point, width: length, height: length, angle: angle = 0deg) = rhombus(
    center: above_foot(top_corner, -height, angle), width: width, height: height, angle: angle
)

/// A kite, pointing down: `shoulder` is how far above the lower tip it is widest.
///
/// Lies with its long tip down.
///
/// ```aidl
/// solid sail { body = kite(width: 40, height: 60, shoulder: 42) }
/// ```
shape kite(
    center: point = (0, 0),
    width: length,
    height: length,
    shoulder: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert shoulder <= height, "the shoulder of a kite is not above its top"
    bottom_corner = center + turned((0, -height / 2), angle)
    right_corner = bottom_corner + turned((width / 2, shoulder), angle)
    top_corner = center + turned((0, height / 2), angle)
    left_corner = bottom_corner + turned((-width / 2, shoulder), angle)
    edges[0] = line(right_corner, top_corner)
    edges[1] = line(top_corner, left_corner)
    edges[2] = line(left_corner, bottom_corner)
    edges[3] = line(bottom_corner, right_corner)
    let edge = edges
    let corner = [right_corner, top_corner, left_corner, bottom_corner]
    let corners = corner
}
// By its lower or upper corner, about which it turns.
fn kite(
    bottom_corner: point, width: length, height: length, shoulder: length, angle: angle = 0deg
) = kite(above_foot(bottom_corner, height, angle), width, height, shoulder, angle)
fn kite(top_corner: point, width: length, height: length, shoulder: length, angle: angle = 0deg) =
    kite(above_foot(top_corner, -height, angle), width, height, shoulder, angle)

/// A straight bar with square ends from `start` to `end`; with two widths it tapers. With round ends it is a `slot`.
///
/// Its corners are `outline.corner[i]`, counter-clockwise from the right of the start.
///
/// ```aidl
/// solid trestle {
///     left = strip(start: (-25, 0), end: (-4, 60), width: 5)
///     right = strip(start: (25, 0), end: (4, 60), width: 5)
///     rung = strip(start: (-22, 20), end: (22, 20), start_width: 6, end_width: 3)
///     top = strip(start: (-12, 60), end: (12, 60), width: 5)
/// }
/// ```
shape strip(start: point, end: point, width: length) {
    outline = polygon(strip_corners(start, end, width / 2, width / 2))
}
shape strip(start: point, end: point, start_width: length, end_width: length) {
    outline = polygon(strip_corners(start, end, start_width / 2, end_width / 2))
}
fn strip_corners(start: point, end: point, near: length, far: length) =
    strip_around(start, end, near, far, turned(unit(end - start), 90deg) / 1mm)
fn strip_around(start: point, end: point, near: length, far: length, left: point) =
    [start - left * near, end - left * far, end + left * far, start + left * near]

alias trapezium = trapezoid
alias diamond = rhombus
