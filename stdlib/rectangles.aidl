// Rectangles and what is made from them. A shape has named parts to constrain against, not only an outline.
//
// A constructor that says the same numbers in other words is a `fn`. One that mixes a position with a size is a
// `shape`, so that both are bound: `rectangle(bottom_left: p, width: 10, height: 5)` stays at p when its width
// has to change.

/// A rectangle, by its centre, a corner, the middle of a side, two opposite corners, or where its sides are.
///
/// Its edges are `left`, `right`, `top` and `bottom`, its corners `bottom_left` to `top_left`, both also as the
/// lists `edge` and `corner` (counter-clockwise from the bottom). It stays parallel to the axes until something
/// asks it to turn: an `angle`, `rotatable: true`, or a constraint on its angle.
///
/// ```aidl
/// solid door {
///     leaf = rectangle(bottom_left: (0, 0), width: 40, height: 90)
///     hole window { pane = rectangle(center: (18, 65), width: 24, height: 30) }
///     constrain window.pane.top.midpoint == leaf.top.midpoint - (0, 8)
/// }
/// ```
shape rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    let along = (width / 2 * cos(angle), width / 2 * sin(angle))
    let across = (-(height / 2 * sin(angle)), height / 2 * cos(angle))
    bottom_left = center - along - across
    bottom_right = center + along - across
    top_right = center + along + across
    top_left = center - along + across
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

// Of two coordinates, the one that was written smaller, or larger.
fn written_min(a: length, b: length) = if written(a) <= written(b) then a else b
fn written_max(a: length, b: length) = if written(a) <= written(b) then b else a

/// By two opposite corners, in any order.
fn rectangle(start: point, end: point) = rectangle(
    bottom_left: (written_min(start.x, end.x), written_min(start.y, end.y)),
    top_right: (written_max(start.x, end.x), written_max(start.y, end.y))
)
fn rectangle(bottom_left: point, top_right: point) = rectangle(
    bottom_left: bottom_left, width_to: (top_right.x, fixed(0)), height_to: (fixed(0), top_right.y)
)
fn rectangle(top_left: point, bottom_right: point) =
    rectangle(bottom_left: (top_left.x, bottom_right.y), top_right: (bottom_right.x, top_left.y))

/// By the coordinates of its sides.
fn rectangle(left: length, right: length, bottom: length, top: length) =
    rectangle(bottom_left: (left, bottom), top_right: (right, top))
fn rectangle(left: length, bottom: length, width: length, height: length) =
    rectangle((left, bottom), -1, -1, width, height)
fn rectangle(left: length, top: length, width: length, height: length) =
    rectangle((left, top), -1, 1, width, height)

/// By a corner, about which it turns.
fn rectangle(bottom_left: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(bottom_left, -1, -1, width, height, angle, rotatable)
fn rectangle(bottom_right: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(bottom_right, 1, -1, width, height, angle, rotatable)
fn rectangle(top_right: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(top_right, 1, 1, width, height, angle, rotatable)
fn rectangle(top_left: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(top_left, -1, 1, width, height, angle, rotatable)

/// By the middle of a side, about which it turns.
fn rectangle(bottom_center: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(bottom_center, 0, -1, width, height, angle, rotatable)
fn rectangle(right_center: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(right_center, 1, 0, width, height, angle, rotatable)
fn rectangle(top_center: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(top_center, 0, 1, width, height, angle, rotatable)
fn rectangle(left_center: point, width: length, height: length, angle = 0deg, rotatable = false) =
    rectangle(left_center, -1, 0, width, height, angle, rotatable)

/// With a `radius` it is a `rounded_rectangle`.
fn rectangle(
    center: point = (0, 0),
    width: length,
    height: length,
    radius: length,
    angle = 0deg,
    rotatable = false
) = rounded_rectangle(center, width, height, radius, angle, rotatable)

// By a point of its border: `across` and `up` tell which, from -1 (left, bottom) over 0 (middle) to 1.
shape rectangle(
    anchor: point,
    across: integer,
    up: integer,
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = anchor + turned(((x - across) * width / 2, (y - up) * height / 2), angle)
    center = place(0, 0)
    bottom_left = place(-1, -1)
    bottom_right = place(1, -1)
    top_right = place(1, 1)
    top_left = place(-1, 1)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

// By its lower left corner and two points, one somewhere on its right side and one on its top. Of these only one
// coordinate counts, so that what is kept between literal points is a width and a height.
shape rectangle(bottom_left: point, width_to: point, height_to: point) {
    bottom_right = (width_to.x, bottom_left.y)
    top_right = (width_to.x, height_to.y)
    top_left = (bottom_left.x, height_to.y)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    center = (bottom_left + top_right) / 2
    let angle = 0deg
    let width = width_to.x - bottom_left.x
    let height = height_to.y - bottom_left.y
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
    assert width >= 0, "the right side of this rectangle is on the left of its left side"
    assert height >= 0, "the top of this rectangle is below its bottom"
}

/// A square, by its centre or a corner.
///
/// ```aidl
/// solid tile {
///     body = square(size: 40)
///     hole window { pane = square(size: 20, angle: 45deg) }
/// }
/// ```
shape square(center: point = (0, 0), size: length, angle: turn = 0deg, rotatable: bool = false) {
    let along = (size / 2 * cos(angle), size / 2 * sin(angle))
    let across = (-(size / 2 * sin(angle)), size / 2 * cos(angle))
    bottom_left = center - along - across
    bottom_right = center + along - across
    top_right = center + along + across
    top_left = center - along + across
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let width = size
    let height = size
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

/// By a corner, about which it turns.
fn square(bottom_left: point, size: length, angle = 0deg, rotatable = false) =
    square(bottom_left, -1, -1, size, angle, rotatable)
fn square(bottom_right: point, size: length, angle = 0deg, rotatable = false) =
    square(bottom_right, 1, -1, size, angle, rotatable)
fn square(top_right: point, size: length, angle = 0deg, rotatable = false) =
    square(top_right, 1, 1, size, angle, rotatable)
fn square(top_left: point, size: length, angle = 0deg, rotatable = false) =
    square(top_left, -1, 1, size, angle, rotatable)

// By a point of its border, as the rectangle.
shape square(
    anchor: point,
    across: integer,
    up: integer,
    size: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    fn place(x, y) = anchor + turned(((x - across) * size / 2, (y - up) * size / 2), angle)
    center = place(0, 0)
    bottom_left = place(-1, -1)
    bottom_right = place(1, -1)
    top_right = place(1, 1)
    top_left = place(-1, 1)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
    let width = size
    let height = size
    let corner = [bottom_left, bottom_right, top_right, top_left]
    let edge = [bottom, right, top, left]
    let corners = corner
    let edges = edge
}

/// A frame: the area between two rectangles about one centre.
///
/// ```aidl
/// solid picture_frame { body = frame(width: 60, height: 40, thickness: 5) }
/// ```
shape frame(center: point = (0, 0), width: length, height: length, thickness: length) {
    outer = rectangle(center: center, width: width, height: height)
    inner = rectangle(center: center, width: width - 2 * thickness, height: height - 2 * thickness)
    assert 2 * thickness < min(width, height),
        "the bars of a frame are thinner than half of its shorter side"
}

alias rect = rectangle
