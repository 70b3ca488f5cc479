// Rectangles whose corners are round or cut off: the names of a rectangle stay, and each corner gets one more.

// A quarter of a circle, counter-clockwise from a direction.
fn quarter_arc(center: point, radius: length, from: angle) =
    arc(center: center, radius: radius, start_angle: fixed(from), end_angle: fixed(from + 90deg))

/// A rectangle with round corners, by its centre, a corner, the middle of a side or its sides, with one radius or four.
///
/// The round corners are `corner_bottom_left` and so on; `bottom_left` is where the sharp corner would be. Four
/// `radii` go counter-clockwise from the bottom left corner, and may be 0.
///
/// ```aidl
/// solid panel {
///     body = rounded_rectangle(width: 60, height: 30, radius: 6)
///     hole tab { cut = rounded_rectangle(width: 30, height: 12, radii: [0, 0, 6, 6]) }
/// }
/// ```
shape rounded_rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    radius: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x, y), angle)
    let x = width / 2 - radius
    let y = height / 2 - radius
    bottom_left = place(-width / 2, -height / 2)
    bottom_right = place(width / 2, -height / 2)
    top_right = place(width / 2, height / 2)
    top_left = place(-width / 2, height / 2)
    corner_bottom_left = quarter_arc(place(-x, -y), radius, angle + 180deg)
    corner_bottom_right = quarter_arc(place(x, -y), radius, angle + 270deg)
    corner_top_right = quarter_arc(place(x, y), radius, angle)
    corner_top_left = quarter_arc(place(-x, y), radius, angle + 90deg)
    bottom = line(corner_bottom_left.end, corner_bottom_right.start)
    right = line(corner_bottom_right.end, corner_top_right.start)
    top = line(corner_top_right.end, corner_top_left.start)
    left = line(corner_top_left.end, corner_bottom_left.start)
    assert 2 * radius <= min(width, height),
        "the radius of the corners is at most half of the shorter side"
}

/// With a radius for each corner, as a list counter-clockwise from the bottom left one, or by name.
fn rounded_rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    radii: list,
    angle = 0deg,
    rotatable = false
) = if len(radii) == 4 then rounded_rectangle(
    center: center,
    width: width,
    height: height,
    radius_bottom_left: radii[0],
    radius_bottom_right: radii[1],
    radius_top_right: radii[2],
    radius_top_left: radii[3],
    angle: angle,
    rotatable: rotatable
) else refuse("a rectangle has four radii, counter-clockwise from the bottom left corner")
shape rounded_rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    radius_bottom_left: length,
    radius_bottom_right: length,
    radius_top_right: length,
    radius_top_left: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x, y), angle)
    let w = width / 2
    let h = height / 2
    let a = radius_bottom_left
    let b = radius_bottom_right
    let c = radius_top_right
    let d = radius_top_left
    bottom_left = place(-w, -h)
    bottom_right = place(w, -h)
    top_right = place(w, h)
    top_left = place(-w, h)
    corner_bottom_left = quarter_arc(place(a - w, a - h), a, angle + 180deg)
    corner_bottom_right = quarter_arc(place(w - b, b - h), b, angle + 270deg)
    corner_top_right = quarter_arc(place(w - c, h - c), c, angle)
    corner_top_left = quarter_arc(place(d - w, h - d), d, angle + 90deg)
    bottom = line(corner_bottom_left.end, corner_bottom_right.start)
    right = line(corner_bottom_right.end, corner_top_right.start)
    top = line(corner_top_right.end, corner_top_left.start)
    left = line(corner_top_left.end, corner_bottom_left.start)
    assert min(a, b, c, d) >= 0, "the radius of a corner is not negative"
    assert max(a + b, d + c) <= width, "two round corners of a level side overlap"
    assert max(a + d, b + c) <= height, "two round corners of an upright side overlap"
}

/// By a corner, about which it turns.
fn rounded_rectangle(
    bottom_left: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(bottom_left, -1, -1, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    bottom_right: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(bottom_right, 1, -1, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    top_right: point, width: length, height: length, radius: length, angle = 0deg, rotatable = false
) = rounded_rectangle(top_right, 1, 1, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    top_left: point, width: length, height: length, radius: length, angle = 0deg, rotatable = false
) = rounded_rectangle(top_left, -1, 1, width, height, radius, angle, rotatable)

/// By the middle of a side, about which it turns.
fn rounded_rectangle(
    bottom_center: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(bottom_center, 0, -1, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    right_center: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(right_center, 1, 0, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    top_center: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(top_center, 0, 1, width, height, radius, angle, rotatable)
fn rounded_rectangle(
    left_center: point,
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(left_center, -1, 0, width, height, radius, angle, rotatable)

/// By the coordinates of its sides.
fn rounded_rectangle(left: length, right: length, bottom: length, top: length, radius: length) =
    rounded_rectangle((left, bottom), -1, -1, right - left, top - bottom, radius)
fn rounded_rectangle(left: length, bottom: length, width: length, height: length, radius: length) =
    rounded_rectangle((left, bottom), -1, -1, width, height, radius)
fn rounded_rectangle(left: length, top: length, width: length, height: length, radius: length) =
    rounded_rectangle((left, top), -1, 1, width, height, radius)

// By a point of its border, as the rectangle.
shape rounded_rectangle(
    anchor: point,
    across: integer,
    up: integer,
    width: length,
    height: length,
    radius: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    center = anchor - turned((across * width / 2, up * height / 2), angle)
    fn place(x, y) = center + turned((x, y), angle)
    let x = width / 2 - radius
    let y = height / 2 - radius
    bottom_left = place(-width / 2, -height / 2)
    bottom_right = place(width / 2, -height / 2)
    top_right = place(width / 2, height / 2)
    top_left = place(-width / 2, height / 2)
    corner_bottom_left = quarter_arc(place(-x, -y), radius, angle + 180deg)
    corner_bottom_right = quarter_arc(place(x, -y), radius, angle + 270deg)
    corner_top_right = quarter_arc(place(x, y), radius, angle)
    corner_top_left = quarter_arc(place(-x, y), radius, angle + 90deg)
    bottom = line(corner_bottom_left.end, corner_bottom_right.start)
    right = line(corner_bottom_right.end, corner_top_right.start)
    top = line(corner_top_right.end, corner_top_left.start)
    left = line(corner_top_left.end, corner_bottom_left.start)
    assert 2 * radius <= min(width, height),
        "the radius of the corners is at most half of the shorter side"
}

/// A rectangle whose corners are cut off at 45 degrees, by its centre, a corner, the middle of a side or its sides.
///
/// The cuts are `corner_bottom_left` and so on; `bottom_left` is where the sharp corner would be. `chamfer` is
/// what each cut takes from a side.
///
/// ```aidl
/// solid plate { body = chamfered_rectangle(width: 60, height: 30, chamfer: 6) }
/// ```
shape chamfered_rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    chamfer: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = center + turned((x, y), angle)
    let w = width / 2
    let h = height / 2
    let x = w - chamfer
    let y = h - chamfer
    bottom_left = place(-w, -h)
    bottom_right = place(w, -h)
    top_right = place(w, h)
    top_left = place(-w, h)
    bottom = line(place(-x, -h), place(x, -h))
    right = line(place(w, -y), place(w, y))
    top = line(place(x, h), place(-x, h))
    left = line(place(-w, y), place(-w, -y))
    corner_bottom_left = line(left.end, bottom.start)
    corner_bottom_right = line(bottom.end, right.start)
    corner_top_right = line(right.end, top.start)
    corner_top_left = line(top.end, left.start)
    assert 2 * chamfer <= min(width, height), "the cuts take at most half of the shorter side"
}

/// By a corner, about which it turns.
fn chamfered_rectangle(
    bottom_left: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(bottom_left, -1, -1, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    bottom_right: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(bottom_right, 1, -1, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    top_right: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(top_right, 1, 1, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    top_left: point, width: length, height: length, chamfer: length, angle = 0deg, rotatable = false
) = chamfered_rectangle(top_left, -1, 1, width, height, chamfer, angle, rotatable)

/// By the middle of a side, about which it turns.
fn chamfered_rectangle(
    bottom_center: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(bottom_center, 0, -1, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    right_center: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(right_center, 1, 0, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    top_center: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(top_center, 0, 1, width, height, chamfer, angle, rotatable)
fn chamfered_rectangle(
    left_center: point,
    width: length,
    height: length,
    chamfer: length,
    angle = 0deg,
    rotatable = false
) = chamfered_rectangle(left_center, -1, 0, width, height, chamfer, angle, rotatable)

/// By the coordinates of its sides.
fn chamfered_rectangle(left: length, right: length, bottom: length, top: length, chamfer: length) =
    chamfered_rectangle((left, bottom), -1, -1, right - left, top - bottom, chamfer)
fn chamfered_rectangle(
    left: length, bottom: length, width: length, height: length, chamfer: length
) = chamfered_rectangle((left, bottom), -1, -1, width, height, chamfer)
fn chamfered_rectangle(left: length, top: length, width: length, height: length, chamfer: length) =
    chamfered_rectangle((left, top), -1, 1, width, height, chamfer)

// By a point of its border, as the rectangle.
shape chamfered_rectangle(
    anchor: point,
    across: integer,
    up: integer,
    width: length,
    height: length,
    chamfer: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    center = anchor - turned((across * width / 2, up * height / 2), angle)
    fn place(x, y) = center + turned((x, y), angle)
    let w = width / 2
    let h = height / 2
    let x = w - chamfer
    let y = h - chamfer
    bottom_left = place(-w, -h)
    bottom_right = place(w, -h)
    top_right = place(w, h)
    top_left = place(-w, h)
    bottom = line(place(-x, -h), place(x, -h))
    right = line(place(w, -y), place(w, y))
    top = line(place(x, h), place(-x, h))
    left = line(place(-w, y), place(-w, -y))
    corner_bottom_left = line(left.end, bottom.start)
    corner_bottom_right = line(bottom.end, right.start)
    corner_top_right = line(right.end, top.start)
    corner_top_left = line(top.end, left.start)
    assert 2 * chamfer <= min(width, height), "the cuts take at most half of the shorter side"
}

alias rounded_rect = rounded_rectangle
alias round_rect = rounded_rectangle
alias round_rectangle = rounded_rectangle
alias chamfered_rect = chamfered_rectangle
alias beveled_rectangle = chamfered_rectangle
