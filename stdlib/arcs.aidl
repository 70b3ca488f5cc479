// Outlines of arcs that are more than one circle: cut shafts, keyholes, lenses.

/// A disc with one flat, as of a D-shaft: `height` is from the flat to the round side; the flat is on top.
///
/// Lies flat side up; `center` is that of the disc.
///
/// ```aidl
/// solid knob {
///     body = circle(center: origin, radius: 15)
///     hole shaft { cut = d_shape(diameter: 6, height: 4.5) }
/// }
/// ```
shape d_shape(
    center: point = (0, 0),
    radius: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert 0.000001 * radius < height < 2 * radius, "the flat of a D cuts its circle"
    let opening = acos((height - radius) / radius)
    rim = arc(
        center: center,
        radius: radius,
        start_angle: angle + 90deg + opening,
        end_angle: angle + 450deg - opening
    )
    flat = line(rim.end, rim.start)
}
fn d_shape(center: point = (0, 0), diameter: length, height: length, angle: angle = 0deg) =
    d_shape(center: center, radius: diameter / 2, height: height, angle: angle)

/// A disc with two parallel flats, `top` and `bottom`.
///
/// Lies with its flats level.
///
/// ```aidl
/// solid key { body = double_d(diameter: 20, across_flats: 14) }
/// ```
shape double_d(
    center: point = (0, 0),
    radius: length,
    across_flats: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert across_flats < 2 * radius, "the flats of a double D cut its circle"
    let opening = asin(across_flats / (2 * radius))
    right = arc(
        center: center, radius: radius, start_angle: angle - opening, end_angle: angle + opening
    )
    left = arc(
        center: center,
        radius: radius,
        start_angle: angle + 180deg - opening,
        end_angle: angle + 180deg + opening
    )
    top = line(right.end, left.start)
    bottom = line(left.end, right.start)
}
fn double_d(center: point = (0, 0), diameter: length, across_flats: length, angle: angle = 0deg) =
    double_d(center: center, radius: diameter / 2, across_flats: across_flats, angle: angle)

/// A keyhole: a round head and a slit below it, `length` from the centre of the head to that of its round end.
///
/// Its edges are the arcs `head` and `foot` and the lines `left` and `right`.
///
/// Lies slit down; `center` is that of the head.
///
/// ```aidl
/// solid hanger_plate {
///     body = rectangle(width: 30, height: 50)
///     hole keyhole { cut = keyhole(center: (0, 6), radius: 6, width: 5, length: 18) }
/// }
/// ```
shape keyhole(
    center: point = (0, 0),
    radius: length,
    width: length,
    length: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert width < 2 * radius, "the slit of a keyhole is narrower than its head"
    assert length > radius, "the slit of a keyhole is longer than the radius of its head"
    let opening = asin(width / (2 * radius))
    let down = angle - 90deg
    head = arc(
        center: center,
        radius: radius,
        start_angle: down + opening,
        end_angle: down + 360deg - opening
    )
    foot = half_turn(center + polar(length, down), width / 2, angle + 180deg)
    left = line(head.end, foot.start)
    right = line(foot.end, head.start)
}
fn keyhole(center: point = (0, 0), diameter: length, width: length, length: length, angle = 0deg) =
    keyhole(center, diameter / 2, width, length, angle)

/// A lens: two equal arcs, `upper` and `lower`, that meet in tips on the left and on the right.
///
/// ```aidl
/// solid eye { body = lens(width: 50, height: 24) }
/// ```
shape lens(
    center: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert height <= width, "a lens is not higher than wide"
    let radius = (width ^ 2 + height ^ 2) / (4 * height)
    let opening = asin(width / (2 * radius))
    fn side(to: angle) = arc(
        center: center - polar(radius - height / 2, to),
        radius: radius,
        start_angle: to - opening,
        end_angle: to + opening
    )
    upper = side(angle + 90deg)
    lower = side(angle + 270deg)
}

/// A crescent: a disc from which another is taken whose centre is `offset` to the right.
///
/// Lies open to the right; `center` is that of the disc.
///
/// ```aidl
/// solid moon { body = crescent(outer_radius: 25, inner_radius: 21, offset: 10) }
/// ```
shape crescent(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    offset: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert abs(outer_radius - inner_radius) < offset < outer_radius + inner_radius,
        "the two circles of a crescent cross each other"
    let x = (outer_radius ^ 2 - inner_radius ^ 2 + offset ^ 2) / (2 * offset)
    let y = sqrt(outer_radius ^ 2 - x ^ 2)
    let wide = atan2(y, x)
    let narrow = atan2(y, x - offset)
    outer = arc(
        center: center,
        radius: outer_radius,
        start_angle: angle + wide,
        end_angle: angle + 360deg - wide
    )
    inner = arc(
        center: center + polar(offset, angle),
        radius: inner_radius,
        start_angle: angle + narrow,
        end_angle: angle + 360deg - narrow
    )
}

/// A Reuleaux polygon: round sides, and the same `width` in every direction; `sides` is odd.
///
/// Lies tip up; `center` is that of its corners.
///
/// ```aidl
/// solid drill_guide { body = reuleaux(width: 40) }
/// ```
shape reuleaux(
    center: point = (0, 0),
    width: length,
    sides: integer = 3,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert sides >= 3 and sides % 2 == 1, "a Reuleaux polygon has an odd number of sides"
    let half = 90deg / sides
    for i in 0..<sides {
        corner[i] = center + polar(width / (2 * cos(half)), angle + 90deg + 4 * half * i)
        edges[i] = arc(
            center: corner[i],
            radius: width,
            start_angle: angle + 270deg + 4 * half * i - half,
            end_angle: angle + 270deg + 4 * half * i + half
        )
    }
    let corners = corner
    let edge = edges
}

alias d_shaft = d_shape
alias d_hole = d_shape
alias double_d_shape = double_d
alias vesica = lens
alias vesica_piscis = lens
alias moon = crescent
alias lune = crescent
alias reuleaux_triangle = reuleaux
