// The relatives of the circle: rings, slices, slots, and what is cut off straight.

/// By its width and height. Numbers without a name are `rx` and `ry`.
fn ellipse(center: point = (0, 0), angle: angle = 0deg, width: length, height: length) =
    ellipse(center: center, rx: width / 2, ry: height / 2, angle: angle)

/// A ring: the area between two circles about one centre, `outer` and `inner`.
///
/// By two radii or diameters, or by one of them and the `thickness` of the wall.
///
/// ```aidl
/// solid washer { body = ring(outer_diameter: 20, inner_diameter: 10) }
/// ```
shape ring(center: point = (0, 0), outer_radius: length, inner_radius: length) {
    outer = circle(center: center, radius: outer_radius)
    inner = circle(center: center, radius: inner_radius)
    let thickness = outer_radius - inner_radius
    assert inner_radius < outer_radius, "the inner radius of a ring is smaller than the outer one"
}
shape ring(center: point = (0, 0), outer_radius: length, thickness: length) {
    outer = circle(center: center, radius: outer_radius)
    inner = circle(center: center, radius: outer_radius - thickness)
    let inner_radius = inner.radius
    assert thickness < outer_radius, "the wall of a ring is thinner than its outer radius"
}
shape ring(center: point = (0, 0), inner_radius: length, thickness: length) {
    outer = circle(center: center, radius: inner_radius + thickness)
    inner = circle(center: center, radius: inner_radius)
    let outer_radius = outer.radius
}
fn ring(center: point = (0, 0), outer_diameter: length, inner_diameter: length) =
    ring(center: center, outer_radius: outer_diameter / 2, inner_radius: inner_diameter / 2)
fn ring(center: point = (0, 0), outer_diameter: length, thickness: length) =
    ring(center: center, outer_radius: outer_diameter / 2, thickness: thickness)
fn ring(center: point = (0, 0), inner_diameter: length, thickness: length) =
    ring(center: center, inner_radius: inner_diameter / 2, thickness: thickness)

/// A slice of a disc, counter-clockwise from `start_angle` to `end_angle`, or over an angle (`sweep`).
///
/// Its edges are the arc `rim` and the lines `first` and `last`.
///
/// Lies from the right upwards; `center` is its tip.
///
/// ```aidl
/// solid slice { body = sector(radius: 30, start_angle: 30deg, end_angle: 100deg) }
/// ```
shape sector(center: point = (0, 0), radius: length, start_angle: angle, end_angle: angle) {
    rim = arc(center: center, radius: radius, start_angle: start_angle, end_angle: end_angle)
    first = line(center, rim.start)
    last = line(rim.end, center)
}
shape sector(center: point = (0, 0), radius: length, sweep: angle, start_angle: angle = 0deg) {
    rim = arc(
        center: center, radius: radius, start_angle: start_angle, end_angle: start_angle + sweep
    )
    first = line(center, rim.start)
    last = line(rim.end, center)
    assert 0deg < sweep < 360deg, "a slice of a disc sweeps less than a full turn"
}
fn sector(center: point = (0, 0), radius: length, angle: angle, start_angle: angle = 0deg) =
    sector(center: center, radius: radius, sweep: angle, start_angle: start_angle)

/// A disc cut off by a straight line, the `chord`; its round side is the arc `rim`.
///
/// By the angles between which the rim runs counter-clockwise, by the width and height of the piece (flat side
/// down, `middle` is that of the chord), or by the ends of the chord and the radius (the smaller piece).
///
/// Lies flat side down by `width`; `center` is that of the disc.
///
/// ```aidl
/// solid arch { body = segment(width: 60, height: 20) }
/// ```
shape segment(center: point = (0, 0), radius: length, start_angle: angle, end_angle: angle) {
    rim = arc(center: center, radius: radius, start_angle: start_angle, end_angle: end_angle)
    chord = line(rim.end, rim.start)
}
shape segment(
    middle: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    let radius = (width ^ 2 / 4 + height ^ 2) / (2 * height)
    let opening = atan2(width / 2, radius - height)
    rim = arc(
        center: middle + polar(height - radius, angle + 90deg),
        radius: radius,
        start_angle: angle + 90deg - opening,
        end_angle: angle + 90deg + opening
    )
    chord = line(rim.end, rim.start)
    let center = rim.center
}
shape segment(start: point, end: point, radius: length) {
    rim = arc(start: start, end: end, radius: radius)
    chord = line(end, start)
    let center = rim.center
}

/// Half a disc, flat side down.
///
/// Lies flat side down; `center` is on it.
///
/// ```aidl
/// solid protractor { body = semicircle(radius: 40) }
/// ```
shape semicircle(
    center: point = (0, 0), radius: length, angle: turn = 0deg, rotatable: bool = false
) {
    rim = half_turn(center, radius, angle)
    chord = line(rim.end, rim.start)
}
fn semicircle(center: point = (0, 0), diameter: length, angle = 0deg, rotatable = false) =
    semicircle(center: center, radius: diameter / 2, angle: angle, rotatable: rotatable)

/// A quarter of a disc, to the right and above its corner (`center`).
///
/// Lies with its corner, `center`, at the lower left.
///
/// ```aidl
/// solid corner_shelf { body = quarter_circle(center: (0, 0), radius: 40) }
/// ```
shape quarter_circle(
    center: point = (0, 0), radius: length, angle: turn = 0deg, rotatable: bool = false
) {
    rim = quarter_arc(center, radius, angle)
    first = line(center, rim.start)
    last = line(rim.end, center)
}

// Half of a circle, counter-clockwise from a direction.
fn half_turn(center: point, radius: length, from: angle) =
    arc(center: center, radius: radius, start_angle: fixed(from), end_angle: fixed(from + 180deg))

/// A piece of a ring, counter-clockwise from `start_angle` to `end_angle`.
///
/// Its edges are the arcs `outer` and `inner` and the lines `first` and `last`.
///
/// Lies around `center`, that of the ring.
///
/// ```aidl
/// solid fan_blade {
///     body = ring_sector(outer_radius: 40, inner_radius: 20, start_angle: 20deg, end_angle: 110deg)
/// }
/// ```
shape ring_sector(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    start_angle: angle,
    end_angle: angle
) {
    assert inner_radius < outer_radius,
        "the inner radius of a piece of a ring is smaller than the outer one"
    outer = arc(
        center: center, radius: outer_radius, start_angle: start_angle, end_angle: end_angle
    )
    inner = arc(
        center: center, radius: inner_radius, start_angle: start_angle, end_angle: end_angle
    )
    first = line(inner.start, outer.start)
    last = line(outer.end, inner.end)
    let thickness = outer_radius - inner_radius
}
shape ring_sector(
    center: point = (0, 0),
    outer_radius: length,
    thickness: length,
    start_angle: angle,
    end_angle: angle
) {
    assert thickness < outer_radius, "a piece of a ring is thinner than its outer radius"
    let inner_radius = outer_radius - thickness
    outer = arc(
        center: center, radius: outer_radius, start_angle: start_angle, end_angle: end_angle
    )
    inner = arc(
        center: center, radius: inner_radius, start_angle: start_angle, end_angle: end_angle
    )
    first = line(inner.start, outer.start)
    last = line(outer.end, inner.end)
}
fn ring_sector(
    center: point = (0, 0),
    inner_radius: length,
    thickness: length,
    start_angle: angle,
    end_angle: angle
) = ring_sector(
    center: center,
    outer_radius: inner_radius + thickness,
    inner_radius: inner_radius,
    start_angle: start_angle,
    end_angle: end_angle
)

/// A straight slot with round ends.
///
/// By the centres of its ends (`start`, `end`), or by its centre and its overall `length`, or the distance of those
/// centres (`center_distance`). Its edges are `left`, `right`, `start_cap` and `end_cap`.
///
/// Lies level.
///
/// ```aidl
/// solid strap {
///     body = slot(start: (0, 0), end: (60, 0), width: 20)
///     hole bolt { cut = slot(center: (30, 0), length: 30, width: 8) }
/// }
/// ```
shape slot(start: point, end: point, width: length) {
    let way = atan2(end.y - start.y, end.x - start.x)
    end_cap = half_turn(end, width / 2, way - 90deg)
    start_cap = half_turn(start, width / 2, way + 90deg)
    right = line(start_cap.end, end_cap.start)
    left = line(end_cap.end, start_cap.start)
    let center = (start + end) / 2
    let length = norm(end - start) + width
    let center_distance = norm(end - start)
}
shape slot(
    center: point = (0, 0),
    length: length,
    width: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert length >= width, "a slot is not shorter than wide"
    start = center - polar((length - width) / 2, angle)
    end = center + polar((length - width) / 2, angle)
    end_cap = half_turn(end, width / 2, angle - 90deg)
    start_cap = half_turn(start, width / 2, angle + 90deg)
    right = line(start_cap.end, end_cap.start)
    left = line(end_cap.end, start_cap.start)
    let center_distance = length - width
}
shape slot(
    center: point = (0, 0),
    center_distance: length,
    width: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert center_distance >= 0, "the distance between the centres of a slot is not negative"
    start = center - polar(center_distance / 2, angle)
    end = center + polar(center_distance / 2, angle)
    end_cap = half_turn(end, width / 2, angle - 90deg)
    start_cap = half_turn(start, width / 2, angle + 90deg)
    right = line(start_cap.end, end_cap.start)
    left = line(end_cap.end, start_cap.start)
    let length = center_distance + width
}

/// A slot along an arc of `radius`, from the centre of one round end at `start_angle` to the other at `end_angle`.
///
/// Lies around `center`, that of the arc.
///
/// ```aidl
/// solid turntable {
///     plate = circle(center: origin, radius: 40)
///     hole guide { cut = arc_slot(radius: 28, width: 8, start_angle: 20deg, end_angle: 160deg) }
/// }
/// ```
shape arc_slot(
    center: point = (0, 0), radius: length, width: length, start_angle: angle, end_angle: angle
) {
    assert width < 2 * radius, "a slot along an arc is narrower than the circle"
    start = center + polar(radius, start_angle)
    end = center + polar(radius, end_angle)
    outer = arc(
        center: center, radius: radius + width / 2, start_angle: start_angle, end_angle: end_angle
    )
    inner = arc(
        center: center, radius: radius - width / 2, start_angle: start_angle, end_angle: end_angle
    )
    end_cap = half_turn(end, width / 2, end_angle)
    start_cap = half_turn(start, width / 2, start_angle + 180deg)
}

/// A slot whose round ends have two radii: two discs and all between them, as a cam or a lever.
///
/// ```aidl
/// solid lever {
///     body = tapered_slot(start: (0, 0), end: (60, 0), start_radius: 16, end_radius: 8)
/// }
/// ```
shape tapered_slot(start: point, end: point, start_radius: length, end_radius: length) {
    assert norm(end - start) > abs(start_radius - end_radius),
        "neither end of a tapered slot lies within the other"
    let way = atan2(end.y - start.y, end.x - start.x)
    let opening = acos((start_radius - end_radius) / norm(end - start))
    start_cap = arc(
        center: start,
        radius: start_radius,
        start_angle: way + opening,
        end_angle: way + 360deg - opening
    )
    end_cap = arc(
        center: end, radius: end_radius, start_angle: way - opening, end_angle: way + opening
    )
    right = line(start_cap.end, end_cap.start)
    left = line(end_cap.end, start_cap.start)
}

alias annulus = ring
alias donut = ring
alias doughnut = ring
alias pie = sector
alias pie_slice = sector
alias wedge = sector
alias circular_sector = sector
alias circular_segment = segment
alias half_circle = semicircle
alias half_disc = semicircle
alias quadrant = quarter_circle
alias annular_sector = ring_sector
alias capsule = slot
alias stadium = slot
alias obround = slot
alias oblong = slot
alias pill = slot
alias bar = slot
alias rod = slot
alias curved_slot = arc_slot
alias disc = circle
alias disk = circle
alias oval = ellipse
