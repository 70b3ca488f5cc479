// Figures: arrows, and outlines of free curves. A figure with `width` and `height` fills that box exactly.

/// An arrow from `start` to `end`, or of a `length` in a direction (`angle`); `end` is its tip.
///
/// `width` is that of the shaft. The corners are `outline.corner[i]`, counter-clockwise from the start of the shaft.
///
/// Lies pointing to the right, held at its `start`.
///
/// ```aidl
/// solid pointer { body = arrow(start: (0, 0), end: (60, 30), width: 8, head_length: 20, head_width: 22) }
/// ```
shape arrow(start: point, end: point, width: length, head_length: length, head_width: length) {
    let length = norm(end - start)
    let way = atan2(end.y - start.y, end.x - start.x)
    outline = polygon(
        arrow_corners(start, way, length, width / 2, length - head_length, head_width / 2)
    )
    let tip = end
    assert head_length <= length, "the head of an arrow is not longer than the arrow"
    assert width <= head_width, "the head of an arrow is not narrower than its shaft"
}
shape arrow(
    start: point = (0, 0),
    length: length,
    width: length,
    head_length: length,
    head_width: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    outline = polygon(
        arrow_corners(start, angle, length, width / 2, length - head_length, head_width / 2)
    )
    let end = outline.corner[3]
    let tip = end
    assert head_length <= length, "the head of an arrow is not longer than the arrow"
    assert width <= head_width, "the head of an arrow is not narrower than its shaft"
}

// Half the width of the shaft is b, of the head h; the head begins at `neck`.
fn arrow_corners(
    start: point, way: angle, length: length, b: length, neck: length, h: length
) = [start + turned(p, way) for p in [
    (0, -b), (neck, -b), (neck, -h), (length, 0), (neck, h), (neck, b), (0, b)
]]

/// An arrow with a head at both ends.
///
/// ```aidl
/// solid size_mark {
///     body = double_arrow(start: (0, 0), end: (80, 0), width: 6, head_length: 16, head_width: 18)
/// }
/// ```
shape double_arrow(
    start: point, end: point, width: length, head_length: length, head_width: length
) {
    let length = norm(end - start)
    let way = atan2(end.y - start.y, end.x - start.x)
    let b = width / 2
    let h = head_width / 2
    let near = head_length
    let far = length - head_length
    fn place(x, y) = start + turned((x, y), way)
    outline = polygon(
        [
            start,
            place(near, -h),
            place(near, -b),
            place(far, -b),
            place(far, -h),
            end,
            place(far, h),
            place(far, b),
            place(near, b),
            place(near, h)
        ]
    )
    assert 2 * head_length <= length, "the heads of an arrow are not longer than the arrow"
    assert width <= head_width, "the heads of an arrow are not narrower than its shaft"
}

/// A house: a rectangle with a gable of `roof_height` on top, also a tag or an arrow-shaped sign.
///
/// ```aidl
/// solid house_front { body = house(width: 50, height: 60, roof_height: 20) }
/// ```
shape house(
    center: point = (0, 0),
    width: length,
    height: length,
    roof_height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert roof_height <= height, "the roof of a house is not higher than the house"
    fn place(x, y) = center + turned((x, y), angle)
    let eaves = height / 2 - roof_height
    bottom_left = place(-width / 2, -height / 2)
    bottom_right = place(width / 2, -height / 2)
    eaves_right = place(width / 2, eaves)
    apex = place(0, height / 2)
    eaves_left = place(-width / 2, eaves)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, eaves_right)
    roof_right = line(eaves_right, apex)
    roof_left = line(apex, eaves_left)
    left = line(eaves_left, bottom_left)
}

/// By the middle of its foot, about which it turns.
fn house(
    bottom_center: point, width: length, height: length, roof_height: length, angle: angle = 0deg
) = house(
    center: above_foot(bottom_center, height, angle),
    width: width,
    height: height,
    roof_height: roof_height,
    angle: angle
)

/// A drop: a circle with two straight sides that meet in a tip above it; `height` is overall.
///
/// Lies tip up; `center` is that of its round side.
///
/// ```aidl
/// solid pendant {
///     body = drop(radius: 15, height: 50)
///     hole eye { rim = circle(center: (0, 0), radius: 6) }
/// }
/// ```
shape drop(
    center: point = (0, 0),
    radius: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert height > 2 * radius, "a drop is higher than the circle at its bottom"
    let way = angle + 90deg
    let opening = acos(radius / (height - radius))
    tip = center + polar(height - radius, way)
    rim = arc(
        center: center,
        radius: radius,
        start_angle: way + opening,
        end_angle: way + 360deg - opening
    )
    right = line(rim.end, tip)
    left = line(tip, rim.start)
}

/// A heart; `tip` is its lowest point and `dip` the one between the lobes.
///
/// ```aidl
/// solid ornament { body = heart(width: 50, height: 46) }
/// ```
shape heart(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    // In shares of half the width and half the height.
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    tip = place(0, -1)
    dip = place(0, 0.5)
    right_side = bezier(tip, place(0.35, -0.6), place(1, -0.2), place(1, 0.4))
    right_lobe = bezier(right_side.end, place(1, 0.75), place(0.8, 1), place(0.5, 1))
    right_fall = bezier(right_lobe.end, place(0.25, 1), place(0.05, 0.8), dip)
    left_fall = bezier(dip, place(-0.05, 0.8), place(-0.25, 1), place(-0.5, 1))
    left_lobe = bezier(left_fall.end, place(-0.8, 1), place(-1, 0.75), place(-1, 0.4))
    left_side = bezier(left_lobe.end, place(-1, -0.2), place(-0.35, -0.6), tip)
}

/// An egg, widest a little below its middle.
///
/// ```aidl
/// solid egg_cup_rim { body = egg(width: 40, height: 54) }
/// ```
shape egg(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    // Four quarters of ellipses that meet at the widest place.
    let waist = -0.2
    let lower = waist + (-1 - waist) * round_handle
    let upper = waist + (1 - waist) * round_handle
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    right = place(1, waist)
    top = place(0, 1)
    left = place(-1, waist)
    bottom = place(0, -1)
    upper_right = bezier(right, place(1, upper), place(round_handle, 1), top)
    upper_left = bezier(top, place(-round_handle, 1), place(-1, upper), left)
    lower_left = bezier(left, place(-1, lower), place(-round_handle, -1), bottom)
    lower_right = bezier(bottom, place(round_handle, -1), place(1, lower), right)
}

// How far the handles of a Bézier curve reach along the sides of its box to be a quarter of an ellipse, and of a
// superellipse of exponent 4 (whose middle is theirs).
let round_handle = 4 / 3 * (sqrt(2) - 1)
let squircle_handle = (8 * 2 ^ (-1 / 4) - 4) / 3

/// A squircle: between a square and a circle, a superellipse of exponent 4.
///
/// ```aidl
/// solid app_icon { body = squircle(size: 40) }
/// ```
shape squircle(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    let k = squircle_handle
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    right = place(1, 0)
    top = place(0, 1)
    left = place(-1, 0)
    bottom = place(0, -1)
    upper_right = bezier(right, place(1, k), place(k, 1), top)
    upper_left = bezier(top, place(-k, 1), place(-1, k), left)
    lower_left = bezier(left, place(-1, -k), place(-k, -1), bottom)
    lower_right = bezier(bottom, place(k, -1), place(1, -k), right)
}
shape squircle(center: point = (0, 0), size: length, angle: turn = 0deg, rotatable: bool = false) {
    let k = squircle_handle
    fn place(x, y) = center + turned((x * size / 2, y * size / 2), angle)
    right = place(1, 0)
    top = place(0, 1)
    left = place(-1, 0)
    bottom = place(0, -1)
    upper_right = bezier(right, place(1, k), place(k, 1), top)
    upper_left = bezier(top, place(-k, 1), place(-1, k), left)
    lower_left = bezier(left, place(-1, -k), place(-k, -1), bottom)
    lower_right = bezier(bottom, place(k, -1), place(1, -k), right)
}

/// A leaf: round at its `foot`, widest below its middle, and pointed at its `tip`.
///
/// Lies tip up.
///
/// ```aidl
/// solid basil {
///     blade = leaf(width: 26, height: 50)
///     drawing veins { rib = line((0, -25), (0, 20)) }
/// }
/// ```
shape leaf(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    // In shares of half the width and half the height.
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    foot = place(0, -1)
    tip = place(0, 1)
    right_side = bezier(foot, place(0.55, -1), place(1, -0.7), place(1, -0.25))
    right_rise = bezier(right_side.end, place(1, 0.2), place(0.3, 0.6), tip)
    left_rise = bezier(tip, place(-0.3, 0.6), place(-1, 0.2), place(-1, -0.25))
    left_side = bezier(left_rise.end, place(-1, -0.7), place(-0.55, -1), foot)
}

/// A cloud of five lobes on a straight `bottom`, as a child draws it.
///
/// ```aidl
/// assembly sky {
///     @color("white") solid weather { body = cloud(width: 60, height: 32) }
/// }
/// ```
shape cloud(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    // In shares of half the width and half the height.
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    bottom = line(place(-0.7, -1), place(0.7, -1))
    right_end = bezier(bottom.end, place(0.87, -1), place(1, -0.83), place(1, -0.57))
    right_lobe = bezier(right_end.end, place(1, -0.3), place(0.92, -0.1), place(0.78, -0.1))
    right_rise = bezier(right_lobe.end, place(0.92, 0.45), place(0.62, 0.75), place(0.4, 0.5))
    right_top = bezier(right_rise.end, place(0.36, 0.82), place(0.2, 1), place(0, 1))
    left_top = bezier(right_top.end, place(-0.2, 1), place(-0.36, 0.82), place(-0.4, 0.5))
    left_rise = bezier(left_top.end, place(-0.62, 0.75), place(-0.92, 0.45), place(-0.78, -0.1))
    left_lobe = bezier(left_rise.end, place(-0.92, -0.1), place(-1, -0.3), place(-1, -0.57))
    left_end = bezier(left_lobe.end, place(-1, -0.83), place(-0.87, -1), bottom.start)
}

alias teardrop = drop
alias superellipse = squircle
alias two_headed_arrow = double_arrow
