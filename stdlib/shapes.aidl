// Compound shapes: each has named parts to constrain against, not only an outline.

/// A rectangle about its centre. It stays parallel to the axes until something asks it to turn: `angle`,
/// `rotatable: true`, or a constraint on its angle.
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
    let corners = [bottom_left, bottom_right, top_right, top_left]
    let edges = [bottom, right, top, left]
}

/// A square about its centre.
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
}

/// A rectangle with round corners.
shape rounded_rectangle(center: point = (0, 0), width: length, height: length, radius: length) {
    let w = width / 2
    let h = height / 2
    let r = radius
    bottom_left = center + (-w, -h)
    bottom_right = center + (w, -h)
    top_right = center + (w, h)
    top_left = center + (-w, h)
    bottom = line(center + (-w + r, -h), center + (w - r, -h))
    corner_bottom_right = arc(
        center: center + (w - r, -h + r),
        radius: r,
        start_angle: fixed(270deg),
        end_angle: fixed(360deg)
    )
    right = line(center + (w, -h + r), center + (w, h - r))
    corner_top_right = arc(
        center: center + (w - r, h - r),
        radius: r,
        start_angle: fixed(0deg),
        end_angle: fixed(90deg)
    )
    top = line(center + (w - r, h), center + (-w + r, h))
    corner_top_left = arc(
        center: center + (-w + r, h - r),
        radius: r,
        start_angle: fixed(90deg),
        end_angle: fixed(180deg)
    )
    left = line(center + (-w, h - r), center + (-w, -h + r))
    corner_bottom_left = arc(
        center: center + (-w + r, -h + r),
        radius: r,
        start_angle: fixed(180deg),
        end_angle: fixed(270deg)
    )
}

/// A trapezoid: two level sides, symmetric about its vertical axis.
shape trapezoid(center: point = (0, 0), bottom_width: length, top_width: length, height: length) {
    bottom_left = center + (-bottom_width / 2, -height / 2)
    bottom_right = center + (bottom_width / 2, -height / 2)
    top_right = center + (top_width / 2, height / 2)
    top_left = center + (-top_width / 2, height / 2)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
}

/// A parallelogram: level sides of `width`, the upper one shifted by `shift`.
shape parallelogram(center: point = (0, 0), width: length, height: length, shift: length) {
    bottom_left = center + (-(width + shift) / 2, -height / 2)
    bottom_right = bottom_left + (width, 0)
    top_right = bottom_right + (shift, height)
    top_left = bottom_left + (shift, height)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, top_right)
    top = line(top_right, top_left)
    left = line(top_left, bottom_left)
}

/// A rhombus by its two diagonals.
shape rhombus(center: point = (0, 0), width: length, height: length) {
    right_corner = center + (width / 2, 0)
    top_corner = center + (0, height / 2)
    left_corner = center - (width / 2, 0)
    bottom_corner = center - (0, height / 2)
    edges[0] = line(right_corner, top_corner)
    edges[1] = line(top_corner, left_corner)
    edges[2] = line(left_corner, bottom_corner)
    edges[3] = line(bottom_corner, right_corner)
}

/// A triangle by three corners, or upright about the centre of its box.
shape triangle(a: point, b: point, c: point) {
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let center = (a + b + c) / 3
}
shape triangle(center: point = (0, 0), base: length, height: length) {
    bottom_left = center + (-base / 2, -height / 2)
    bottom_right = center + (base / 2, -height / 2)
    apex = center + (0, height / 2)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, apex)
    left = line(apex, bottom_left)
}

/// A closed outline of straight edges through the points.
shape polygon(points: list) {
    assert len(points) >= 3, "a polygon has at least three corners"
    for i in 0..<len(points) {
        corner[i] = points[i]
        edges[i] = line(points[i], points[(i + 1) % len(points)])
    }
}

/// Straight edges through the points, not closed.
shape polyline(points: list) {
    assert len(points) >= 2, "a polyline has at least two points"
    for i in 0..<len(points) - 1 {
        edges[i] = line(points[i], points[i + 1])
    }
    let start = points[0]
    let end = points[-1]
}

/// A polygon of equal sides with its corners on a circle; the first corner is at `angle`.
shape regular_polygon(
    center: point = (0, 0),
    radius: length,
    sides: integer,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert sides >= 3, "a polygon has at least three sides"
    for i in 0..<sides {
        corner[i] = center + polar(radius, angle + 360deg / sides * i)
    }
    for i in 0..<sides {
        edges[i] = line(corner[i], corner[(i + 1) % sides])
    }
}

/// A star with `points` tips; the first tip is at `angle`.
shape star(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    points: integer = 5,
    angle: turn = 90deg
) {
    for i in 0..<points {
        tip[i] = center + polar(outer_radius, angle + 360deg / points * i)
        notch[i] = center + polar(inner_radius, angle + 360deg / points * (i + 0.5))
    }
    for i in 0..<points {
        falling[i] = line(tip[i], notch[i])
        rising[i] = line(notch[i], tip[(i + 1) % points])
    }
}

/// A straight slot with round ends, by the centres of its ends or by its centre and overall length.
shape slot(start: point, end: point, width: length) {
    let way = atan2(end.y - start.y, end.x - start.x)
    let side = polar(width / 2, way + 90deg)
    right = line(start - side, end - side)
    end_cap = arc(center: end, radius: width / 2, start_angle: way - 90deg, end_angle: way + 90deg)
    left = line(end + side, start + side)
    start_cap = arc(
        center: start,
        radius: width / 2,
        start_angle: way + 90deg,
        end_angle: way + 270deg
    )
    let center = (start + end) / 2
    let length = norm(end - start) + width
}
shape slot(
    center: point = (0, 0),
    length: length,
    width: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    start = center - polar((length - width) / 2, angle)
    end = center + polar((length - width) / 2, angle)
    let side = polar(width / 2, angle + 90deg)
    right = line(start - side, end - side)
    end_cap = arc(
        center: end,
        radius: width / 2,
        start_angle: angle - 90deg,
        end_angle: angle + 90deg
    )
    left = line(end + side, start + side)
    start_cap = arc(
        center: start,
        radius: width / 2,
        start_angle: angle + 90deg,
        end_angle: angle + 270deg
    )
}

/// A ring: the area between two circles about one centre.
shape ring(center: point = (0, 0), outer_radius: length, inner_radius: length) {
    outer = circle(center: center, radius: outer_radius)
    inner = circle(center: center, radius: inner_radius)
}

/// A slice of a disc, counter-clockwise from `start_angle`.
shape sector(center: point = (0, 0), radius: length, start_angle: angle, end_angle: angle) {
    rim = arc(center: center, radius: radius, start_angle: start_angle, end_angle: end_angle)
    first = line(center, rim.start)
    last = line(rim.end, center)
}

/// A disc cut off by a straight line, counter-clockwise from `start_angle`.
shape segment(center: point = (0, 0), radius: length, start_angle: angle, end_angle: angle) {
    rim = arc(center: center, radius: radius, start_angle: start_angle, end_angle: end_angle)
    chord = line(rim.end, rim.start)
}

/// A cross of two equal bars.
shape cross_shape(center: point = (0, 0), size: length, width: length) {
    let a = size / 2
    let b = width / 2
    outline = polygon(
        [
            center + (b, b),
            center + (b, a),
            center + (-b, a),
            center + (-b, b),
            center + (-a, b),
            center + (-a, -b),
            center + (-b, -b),
            center + (-b, -a),
            center + (b, -a),
            center + (b, -b),
            center + (a, -b),
            center + (a, b)
        ]
    )
}

alias rect = rectangle
alias rounded_rect = rounded_rectangle
alias annulus = ring
alias capsule = slot
alias stadium = slot
alias wedge = sector
alias diamond = rhombus
