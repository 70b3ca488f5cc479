// Arches: outlines of doors, windows and roofs. Each stands on a flat side and fills its box exactly; it is held by the
// center of that box or by the middle of its foot (`bottom_center`).

/// The outline of a door or window with a round top; `rise` is how high the top stands over the straight sides.
///
/// Without a `rise` the top is half a circle; with less it is a flat, segmental arch. Its edges are the lines `bottom`,
/// `right` and `left` and the arc `top`.
///
/// ```aidl
/// solid gate {
///     wall = rectangle(bottom_center: origin, width: 60, height: 50)
///     hole door { v = arch(bottom_center: origin, width: 20, height: 34) }
///     hole window { v = arch(center: (20, 30), width: 10, height: 16, rise: 2) }
/// }
/// ```
shape arch(
    center: point = (0, 0),
    width: length,
    height: length,
    rise: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert rise < height, "the top of an arch rises less than the whole is high"
    assert rise <= width / 2, "a round arch rises by half its width at most: take a `pointed_arch`"
    let radius = (width ^ 2 / 4 + rise ^ 2) / (2 * rise)
    let opening = atan2(width / 2, radius - rise)
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    bottom_left = place(-1, -1)
    bottom_right = place(1, -1)
    top = arc(
        center: center + polar(height / 2 - radius, angle + 90deg),
        radius: radius,
        start_angle: angle + 90deg - opening,
        end_angle: angle + 90deg + opening
    )
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top.start)
    left = line(top.end, bottom_left)
    let apex = center + polar(height / 2, angle + 90deg)
}
fn arch(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: angle = 0deg,
    rotatable: bool = false
) = arch(
    center: center,
    width: width,
    height: height,
    rise: width / 2,
    angle: angle,
    rotatable: rotatable
)
fn arch(bottom_center: point, width: length, height: length, angle: angle = 0deg) = arch(
    center: above_foot(bottom_center, height, angle), width: width, height: height, angle: angle
)
fn arch(
    bottom_center: point, width: length, height: length, rise: length, angle: angle = 0deg
) = arch(
    center: above_foot(bottom_center, height, angle),
    width: width,
    height: height,
    rise: rise,
    angle: angle
)

// The center of what stands on a point.
fn above_foot(foot: point, height: length, angle: angle) = foot + polar(height / 2, angle + 90deg)

/// A Gothic door or window: two arcs that rise from upright sides and meet in the point `apex`.
///
/// `rise` is how high the arcs stand over the sides: at least half the `width`, and without it as high as an
/// equilateral triangle. Its edges are `bottom`, `right`, `left`, and the arcs `right_arc` and `left_arc`.
///
/// ```aidl
/// solid chapel {
///     wall = rectangle(bottom_center: origin, width: 60, height: 60)
///     hole door { v = pointed_arch(bottom_center: origin, width: 22, height: 42) }
/// }
/// ```
shape pointed_arch(
    center: point = (0, 0),
    width: length,
    height: length,
    rise: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert rise < height, "the point of an arch rises less than the whole is high"
    assert rise >= width / 2, "a pointed arch rises by half its width at least: take an `arch`"
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    bottom_left = place(-1, -1)
    bottom_right = place(1, -1)
    apex = place(0, 1)
    let spring = center + polar(height / 2 - rise, angle + 90deg)
    right_arc = ogive_side(spring, width, rise, angle, is_left: false)
    left_arc = ogive_side(spring, width, rise, angle, is_left: true)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, right_arc.start)
    left = line(left_arc.end, bottom_left)
}
fn pointed_arch(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: angle = 0deg,
    rotatable: bool = false
) = pointed_arch(
    center: center,
    width: width,
    height: height,
    rise: equilateral * width,
    angle: angle,
    rotatable: rotatable
)
fn pointed_arch(
    bottom_center: point, width: length, height: length, angle: angle = 0deg
) = pointed_arch(
    center: above_foot(bottom_center, height, angle), width: width, height: height, angle: angle
)
fn pointed_arch(
    bottom_center: point, width: length, height: length, rise: length, angle: angle = 0deg
) = pointed_arch(
    center: above_foot(bottom_center, height, angle),
    width: width,
    height: height,
    rise: rise,
    angle: angle
)

// The height of an equilateral triangle over its side.
let equilateral = sqrt(3) / 2

// One of the two arcs over a width about `spring`, that rise upright and meet in a point.
fn ogive_side(spring: point, width: length, rise: length, angle: angle, is_left: bool) = ogive_arc(
    spring,
    (rise ^ 2 + width ^ 2 / 4) / width,
    atan2(rise, (rise ^ 2 - width ^ 2 / 4) / width),
    width / 2,
    angle,
    is_left
)
fn ogive_arc(
    spring: point, radius: length, sweep: angle, half: length, angle: angle, is_left: bool
) = arc(
    center: spring + polar(radius - half, if is_left then angle else angle + 180deg),
    radius: radius,
    start_angle: if is_left then angle + 180deg - sweep else angle,
    end_angle: if is_left then angle + 180deg else angle + sweep
)

/// A pointed nose, as of a bullet or a rocket: two arcs that rise upright from a flat side and meet in the point `apex`.
///
/// The `height` is at least half the `width`.
///
/// ```aidl
/// assembly rocket {
///     solid tube { body = rectangle(width: 20, height: 50) }
///     solid nose { body = ogive(bottom_center: (0, 26), width: 20, height: 34) }
///     constrain nose.stacked_on(tube)
/// }
/// ```
shape ogive(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert height >= width / 2,
        "an ogive is at least half as high as wide: a flatter one is a `segment`"
    let foot = center + polar(height / 2, angle - 90deg)
    apex = center + polar(height / 2, angle + 90deg)
    right_arc = ogive_side(foot, width, height, angle, is_left: false)
    left_arc = ogive_side(foot, width, height, angle, is_left: true)
    bottom = line(left_arc.end, right_arc.start)
}
fn ogive(bottom_center: point, width: length, height: length, angle: angle = 0deg) = ogive(
    center: above_foot(bottom_center, height, angle), width: width, height: height, angle: angle
)

/// An arch of two S-shaped sides, as of an Indian gate or an onion roof; `rise` is the height of the curved part.
///
/// Its edges are `bottom`, `right` and `left`, and from the right side over `apex` to the left one the arcs `arc[0]` to
/// `arc[3]`. Without a `rise` it is as high as wide.
///
/// ```aidl
/// solid shrine {
///     wall = rectangle(bottom_center: origin, width: 50, height: 60)
///     hole niche { v = ogee_arch(bottom_center: (0, 8), width: 26, height: 44, rise: 24) }
/// }
/// ```
shape ogee_arch(
    center: point = (0, 0),
    width: length,
    height: length,
    rise: length = width,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert rise < height,
        "the curved part of an ogee arch, as high as wide without a `rise`, is lower than the whole"
    assert rise >= width / 2, "the curved part of an ogee arch is at least half as high as wide"
    fn place(x, y) = center + turned((x, y), angle)
    let half = width / 2
    let eaves = height / 2 - rise
    let radius = (half ^ 2 + rise ^ 2) / (4 * half)
    let sweep = 2 * atan2(half, rise)
    bottom_left = place(-half, -height / 2)
    bottom_right = place(half, -height / 2)
    apex = place(0, height / 2)
    fn bend(x, y, start: angle) = arc(
        center: place(x, y),
        radius: radius,
        start_angle: angle + start,
        end_angle: angle + start + sweep
    )
    arc[0] = bend(half - radius, eaves, 0deg)
    arc[1] = bend(radius, height / 2, 180deg)
    arc[2] = bend(-radius, height / 2, -sweep)
    arc[3] = bend(radius - half, eaves, 180deg - sweep)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, arc[0].start)
    left = line(arc[3].end, bottom_left)
}
fn ogee_arch(
    bottom_center: point, width: length, height: length, rise: length = width, angle: angle = 0deg
) = ogee_arch(
    center: above_foot(bottom_center, height, angle),
    width: width,
    height: height,
    rise: rise,
    angle: angle
)

/// Half an ellipse, flat side down: a dome, a cap, a lid, an awning.
///
/// Its edges are `bottom` and the curves `right` and `left`, which meet in `apex`. Half a disc is a `semicircle`.
///
/// ```aidl
/// assembly observatory {
///     solid drum { body = rectangle(bottom_center: origin, width: 50, height: 20) }
///     solid roof { body = dome(bottom_center: (0, 22), width: 54, height: 24) }
///     constrain roof.stacked_on(drum)
/// }
/// ```
shape dome(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    // From the middle of the flat side, in shares of half the width and the height.
    fn place(x, y) = center + turned((x * width / 2, (y - 0.5) * height), angle)
    bottom_right = place(1, 0)
    apex = place(0, 1)
    bottom_left = place(-1, 0)
    right = bezier(bottom_right, place(1, round_handle), place(round_handle, 1), apex)
    left = bezier(apex, place(-round_handle, 1), place(-1, round_handle), bottom_left)
    bottom = line(bottom_left, bottom_right)
}
fn dome(bottom_center: point, width: length, height: length, angle: angle = 0deg) = dome(
    center: above_foot(bottom_center, height, angle), width: width, height: height, angle: angle
)

/// A shield: flat on top, straight at the sides, with two arcs that meet in the point `tip` below.
///
/// `rise` is the height of the arcs, without it that of an equilateral triangle; it is at least half the `width`.
///
/// ```aidl
/// solid badge {
///     body = shield(width: 40, height: 48)
///     hole field { v = offset(badge.body, -3) }
/// }
/// ```
shape shield(
    center: point = (0, 0),
    width: length,
    height: length,
    rise: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert rise < height, "the arcs of a shield are lower than the whole"
    assert rise >= width / 2, "the arcs of a shield are at least half as high as it is wide"
    fn place(x, y) = center + turned((x * width / 2, y * height / 2), angle)
    top_left = place(-1, 1)
    top_right = place(1, 1)
    tip = place(0, -1)
    let spring = center + polar(rise - height / 2, angle + 90deg)
    left_arc = ogive_side(spring, width, rise, angle + 180deg, is_left: false)
    right_arc = ogive_side(spring, width, rise, angle + 180deg, is_left: true)
    top = line(top_right, top_left)
    left = line(top_left, left_arc.start)
    right = line(right_arc.end, top_right)
}
fn shield(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: angle = 0deg,
    rotatable: bool = false
) = shield(
    center: center,
    width: width,
    height: height,
    rise: equilateral * width,
    angle: angle,
    rotatable: rotatable
)

alias round_arch = arch
alias arched_window = arch
alias arched_door = arch
alias archway = arch
alias gothic_arch = pointed_arch
alias gothic = pointed_arch
alias lancet = pointed_arch
alias gothic_window = pointed_arch
alias bullet = ogive
alias nose_cone = ogive
alias half_ellipse = dome
alias semi_ellipse = dome
alias escutcheon = shield
alias crest = shield
