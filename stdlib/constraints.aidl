// Constraints on geometry. Where two readings are possible, the one nearest to the first guesses is taken.

/// The points are one point; a point lies on a line (endless), a circle or an arc (whole circle).
constraint coincident(a: point, b: point) { a == b }
constraint coincident(p: point, l: line) { offset_from(p, l) == 0 }
constraint coincident(l: line, p: point) { offset_from(p, l) == 0 }
constraint coincident(p: point, c: circle) { norm(p - c.center) == c.radius }
constraint coincident(c: circle, p: point) { norm(p - c.center) == c.radius }
constraint coincident(p: point, a: arc) { norm(p - a.center) == a.radius }
constraint coincident(a: arc, p: point) { norm(p - a.center) == a.radius }
constraint coincident(points: list) {
    for i in 0..<len(points) - 1 { points[i] == points[-1] }
}

/// Level: a line, or any number of points.
constraint horizontal(l: line) { l.start.y == l.end.y }
constraint horizontal(points: list) {
    for i in 0..<len(points) - 1 { points[i].y == points[-1].y }
}

/// Upright: a line, or any number of points.
constraint vertical(l: line) { l.start.x == l.end.x }
constraint vertical(points: list) {
    for i in 0..<len(points) - 1 { points[i].x == points[-1].x }
}

/// Sine and cosine of the angle between two lines.
fn sine(a: line, b: line) = cross(vector(a), vector(b)) / (a.length * b.length)
fn cosine(a: line, b: line) = dot(vector(a), vector(b)) / (a.length * b.length)

/// The lines run in the same (or opposite) direction.
constraint parallel(lines: list) {
    for i in 0..<len(lines) - 1 { sine(lines[i], lines[-1]) == 0 }
}

/// The lines meet at a right angle.
constraint perpendicular(a: line, b: line) { cosine(a, b) == 0 }

/// The lines (or points) lie on one endless line.
constraint collinear(a: line, b: line) {
    offset_from(a.start, b) == 0
    offset_from(a.end, b) == 0
}
constraint collinear(p: point, l: line) { offset_from(p, l) == 0 }
constraint collinear(a: point, b: point, c: point) { cross(b - a, c - a) / norm(c - b) == 0 }

/// The centres agree.
constraint concentric(things: list) {
    for i in 0..<len(things) - 1 { things[i].center == things[-1].center }
}

/// They touch without crossing: at the end they share, if there is one.
constraint tangent(l: line, c: circle) {
    offset_from(c.center, l) == nearest(offset_from(c.center, l), [c.radius, -c.radius])
}
constraint tangent(c: circle, l: line) { tangent(l, c) }
constraint tangent(a: circle, b: circle) {
    norm(b.center - a.center) == touching_distance(norm(b.center - a.center), a.radius, b.radius)
}
constraint tangent(a: circle, b: circle, inside: bool) {
    norm(b.center - a.center) == (if inside then abs(a.radius - b.radius) else a.radius + b.radius)
}
constraint tangent(a: arc, c: circle) {
    norm(c.center - a.center) == touching_distance(norm(c.center - a.center), a.radius, c.radius)
}
constraint tangent(c: circle, a: arc) { tangent(a, c) }
constraint tangent(l: line, a: arc) {
    let joint = shared_end([l.start, l.end], [a.start, a.end])
    if len(joint) > 0 {
        dot(vector(l), joint[0] - a.center) / l.length == 0
    } else {
        offset_from(a.center, l) == nearest(offset_from(a.center, l), [a.radius, -a.radius])
    }
}
constraint tangent(a: arc, l: line) {
    let joint = shared_end([l.start, l.end], [a.start, a.end])
    if len(joint) > 0 {
        dot(vector(l), joint[0] - a.center) / l.length == 0
    } else {
        offset_from(a.center, l) == nearest(offset_from(a.center, l), [a.radius, -a.radius])
    }
}
constraint tangent(a: arc, b: arc) {
    let joint = shared_end([a.start, a.end], [b.start, b.end])
    if len(joint) > 0 {
        cross(joint[0] - a.center, joint[0] - b.center) / a.radius == 0
    } else {
        norm(b.center - a.center) == touching_distance(
            norm(b.center - a.center),
            a.radius,
            b.radius
        )
    }
}
constraint tangent(a: bezier, b: bezier) {
    let joint = shared_end([a.p0, a.p3], [b.p0, b.p3])
    let from = if norm(written(joint[0] - a.p3)) <= norm(
        written(joint[0] - a.p0)
    ) then a.p2 else a.p1
    let to = if norm(written(joint[0] - b.p0)) <= norm(written(joint[0] - b.p3)) then b.p1 else b.p2
    cross(joint[0] - from, to - joint[0]) / norm(joint[0] - from) == 0
}
constraint tangent(l: line, b: bezier) {
    let joint = shared_end([l.start, l.end], [b.p0, b.p3])
    let to = if norm(written(joint[0] - b.p0)) <= norm(written(joint[0] - b.p3)) then b.p1 else b.p2
    cross(vector(l), to - joint[0]) / l.length == 0
}
constraint tangent(b: bezier, l: line) { tangent(l, b) }

/// The distance of two centres at which round things touch, outside or inside as is nearer.
fn touching_distance(now: length, a: length, b: length) = nearest(now, [a + b, a - b, b - a])

/// The ends that two curves share as they were written; an empty list when they share none.
fn shared_end(a: list, b: list) = [p for p in a if min(
    [norm(written(p - q)) for q in b]
) < 0.000001]

/// The same size: lengths of lines, radii of round things, sides of rectangles, values of numbers.
constraint equal(a: line, b: line) { a.length == b.length }
constraint equal(a: circle, b: circle) { a.radius == b.radius }
constraint equal(a: arc, b: arc) { a.radius == b.radius }
constraint equal(a: arc, b: circle) { a.radius == b.radius }
constraint equal(a: circle, b: arc) { a.radius == b.radius }
constraint equal(a: rectangle, b: rectangle) {
    a.width == b.width
    a.height == b.height
}
constraint equal(a, b) { a == b }
constraint equal(things: list) {
    for i in 0..<len(things) - 1 { equal(things[i], things[-1]) }
}

constraint equal_length(things: list) {
    for i in 0..<len(things) - 1 { things[i].length == things[-1].length }
}
constraint equal_radius(things: list) {
    for i in 0..<len(things) - 1 { things[i].radius == things[-1].radius }
}

/// p is the middle of a line.
constraint midpoint(p: point, l: line) { p == l.midpoint }
constraint midpoint(p: point, a: point, b: point) { p == (a + b) / 2 }

/// The endless level and upright lines through a point.
fn level_through(p: point) = line(fixed(p), fixed(p + (1, 0)))
fn upright_through(p: point) = line(fixed(p), fixed(p + (0, 1)))

/// The mirror image of a point, and how far another is from it as written.
fn mirrored(p: point, about: line) = p - across(about) * (2 * offset_from(p, about))
fn across(l: line) = turned(l.end - l.start, 90deg) / l.length
fn mirror_error(a: point, b: point, about: line) = norm(written(mirrored(a, about) - b))

/// Mirror images of each other: about a line, a point, an axis or a coordinate.
constraint symmetric(a: point, b: point, about: line) {
    offset_from((a + b) / 2, about) == 0
    dot(b - a, vector(about)) / about.length == 0
}
constraint symmetric(a: point, b: point, about: point) { (a + b) / 2 == about }
constraint symmetric(a: circle, b: circle, about: line) {
    symmetric(a.center, b.center, about: about)
    a.radius == b.radius
}
constraint symmetric(a: box, b: box, about: line) {
    symmetric(a.center, b.center, about: about)
    a.width == b.width
    a.height == b.height
}
constraint symmetric(a, b, axis: text) {
    symmetric(
        a,
        b,
        about: if choice(axis, ["x", "y"]) == "x" then level_through((0, 0)) else upright_through(
            (0, 0)
        )
    )
}
constraint symmetric(a, b, axis: length) { symmetric(a, b, about: upright_through((axis, 0))) }
constraint symmetric(a: line, b: line, about: line) {
    let along = mirror_error(a.start, b.start, about) + mirror_error(a.end, b.end, about)
    let against = mirror_error(a.start, b.end, about) + mirror_error(a.end, b.start, about)
    if along <= against {
        symmetric(a.start, b.start, about: about)
        symmetric(a.end, b.end, about: about)
    } else {
        symmetric(a.start, b.end, about: about)
        symmetric(a.end, b.start, about: about)
    }
}

/// Set a measure: the same as `distance(a, b) == value`.
constraint distance(a, b, value: length) { distance(a, b) == value }
constraint horizontal_distance(a: point, b: point, value: length) {
    horizontal_distance(a, b) == value
}
constraint vertical_distance(a: point, b: point, value: length) { vertical_distance(a, b) == value }
constraint length(l, value: length) { l.length == value }
constraint radius(c, value: length) { c.radius == value }
constraint diameter(c, value: length) { c.diameter == value }

/// The angle between two lines, in the reading nearest to the first guesses; `ccw` states it from a to b.
constraint angle(a: line, b: line, value: angle) {
    angle(a, b) == nearest(angle(a, b), [value, -value, 180deg - value, value - 180deg])
}
constraint angle(a: line, b: line, value: angle, ccw: bool) {
    angle(a, b) == (if ccw then value else -value)
}

alias orthogonal = perpendicular
alias square_to = perpendicular
alias right_angle = perpendicular
alias same_point = coincident
alias on = coincident
alias point_on = coincident
alias level = horizontal
alias upright = vertical
alias aligned = collinear
alias symmetrical = symmetric
alias same_length = equal_length
alias same_radius = equal_radius
alias equal_diameter = equal_radius
alias same = equal
