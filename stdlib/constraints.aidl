// Constraints on geometry. Where two readings are possible, the one nearest to the first guesses is taken.
//
// A public constraint says what may be given to it, the plain definitions below it what it means for a pair.

// --- What stands for a thing -----------------------------------------------------------------------

// The point that stands for a thing: itself, its centre, or the centre of its box or of a list's box.
fn center_of(p: point) = p
fn center_of(b: bezier) = refuse("a bezier has no centre; name one of its points, as in `b.start`")
fn center_of(of) = if is_list(of) then of.bb.center else of.center

// The ends of a curve; none of anything else.
fn ends_of(of) = []
fn ends_of(l: line) = [l.start, l.end]
fn ends_of(a: arc) = [a.start, a.end]
fn ends_of(b: bezier) = [b.p0, b.p3]

fn is_list(of) = false
fn is_list(of: list) = true
fn is_line(of) = false
fn is_line(l: line) = true

// Sine and cosine of the angle between two lines.
fn sine(a: line, b: line) = cross(vector(a), vector(b)) / (a.length * b.length)
fn cosine(a: line, b: line) = dot(vector(a), vector(b)) / (a.length * b.length)

// --- Places ----------------------------------------------------------------------------------------

/// The points are one point, or lie on a line (endless), a circle, an arc (whole circle) or an ellipse.
///
/// The last one is held. Two lines become one endless line, two round things one circle.
///
/// ```aidl
/// drawing d {
///     beam = line(fixed((0, 0)), fixed((60, 20)))
///     rim  = circle(center: fixed((60, 20)), radius: 12)
///     pin  = circle(center: (20, 16), radius: 2)
///     tail = line((66, 34), (90, 40))
///     constrain {
///         coincident(pin.center, beam)
///         coincident(tail.start, rim)
///     }
/// }
/// ```
constraint coincident(things: list) {
    for i in 0..<len(things) - 1 { lies_on(things[i], things[-1]) }
}
constraint lies_on(a: point, b: point) { a == b }
constraint lies_on(p: point, l: line) { offset_from(p, l) == 0 }
constraint lies_on(p: point, c: circle) { norm(p - c.center) == c.radius }
constraint lies_on(p: point, a: arc) { norm(p - a.center) == a.radius }
constraint lies_on(p: point, e: ellipse) {
    let q = turned(p - e.center, -e.angle)
    hypot(q.x / e.rx, q.y / e.ry) == 1
}
constraint lies_on(p: point, b: bezier) {
    refuse("a point on a bezier has no closed form; name one of its points, as in `b.end`")
}
constraint lies_on(l: line, p: point) { lies_on(p, l) }
constraint lies_on(c: circle, p: point) { lies_on(p, c) }
constraint lies_on(a: arc, p: point) { lies_on(p, a) }
constraint lies_on(e: ellipse, p: point) { lies_on(p, e) }
constraint lies_on(b: bezier, p: point) { lies_on(p, b) }
constraint lies_on(a: line, b: line) { in_line(a, b) }
constraint lies_on(a: circle, b: circle) { same_circle(a, b) }
constraint lies_on(a: circle, b: arc) { same_circle(a, b) }
constraint lies_on(a: arc, b: circle) { same_circle(a, b) }
constraint lies_on(a: arc, b: arc) { same_circle(a, b) }
constraint same_circle(a, b) {
    a.center == b.center
    a.radius == b.radius
}

/// A point lies on a line between its ends, or on an arc between its ends.
///
/// ```aidl
/// drawing d {
///     beam = line(fixed((0, 0)), fixed((60, 0)))
///     knob = circle(center: (80, 9), radius: 4)
///     constrain on_segment(knob.center, beam)
/// }
/// ```
constraint on_segment(p: point, l: line) {
    offset_from(p, l) == 0
    0 <= dot(p - l.start, vector(l)) / l.length
    dot(p - l.end, vector(l)) / l.length <= 0
}
constraint on_segment(p: point, a: arc) {
    let chord = line(a.start, a.end)
    norm(p - a.center) == a.radius
    if written(offset_from(a.midpoint, chord)) > 0 {
        offset_from(p, chord) >= 0
    } else {
        offset_from(p, chord) <= 0
    }
}

/// The centres agree: of round things, of shapes, of anything that has a centre.
///
/// ```aidl
/// drawing d {
///     rim  = circle(center: fixed((0, 0)), radius: 20)
///     bore = circle(center: (4, 3), radius: 8)
///     nut  = regular_polygon(center: (-3, 2), radius: 14, sides: 6)
///     constrain concentric(bore, nut, rim)
/// }
/// ```
constraint concentric(things: list) {
    for i in 0..<len(things) - 1 { center_of(things[i]) == center_of(things[-1]) }
}

/// A thing is the middle of a line or an arc, or of two others: points, or the centres of things.
///
/// ```aidl
/// drawing d {
///     beam = line(fixed((0, 0)), fixed((60, 20)))
///     eye  = circle(center: (0, 40), radius: 4)
///     nail = circle(center: (0, 30), radius: 2)
///     constrain {
///         midpoint(eye, beam)
///         midpoint(nail, eye, beam.end)
///     }
/// }
/// ```
constraint midpoint(p, l: line) { center_of(p) == l.midpoint }
constraint midpoint(p, a: arc) { center_of(p) == a.midpoint }
constraint midpoint(l: line, p: point) { l.midpoint == p }
constraint midpoint(p, a, b) { halfway(p, from: a, to: b) }
constraint halfway(p, from, to) { center_of(p) == (center_of(from) + center_of(to)) / 2 }

// --- Directions ------------------------------------------------------------------------------------

/// Level: lines, or points (and centres of things) at one height.
///
/// ```aidl
/// drawing d {
///     shelf = line((0, 0), length: 60, angle: guess(8deg))
///     peg   = circle(center: (20, 12), radius: 3)
///     hook  = circle(center: (45, 15), radius: 3)
///     constrain {
///         horizontal(shelf)
///         horizontal(peg, hook)
///     }
/// }
/// ```
constraint horizontal(l: line) { l.start.y == l.end.y }
constraint horizontal(things: list) {
    if alike_in_kind(things) {
        for l in things { l.start.y == l.end.y }
    } else {
        for i in 0..<len(things) - 1 { center_of(things[i]).y == center_of(things[-1]).y }
    }
}

/// Upright: lines, or points (and centres of things) one above the other.
///
/// ```aidl
/// drawing d {
///     post = line((0, 0), length: 60, angle: guess(82deg))
///     peg  = circle(center: (20, 12), radius: 3)
///     hook = circle(center: (24, 40), radius: 3)
///     constrain {
///         vertical(post)
///         vertical(peg, hook)
///     }
/// }
/// ```
constraint vertical(l: line) { l.start.x == l.end.x }
constraint vertical(things: list) {
    if alike_in_kind(things) {
        for l in things { l.start.x == l.end.x }
    } else {
        for i in 0..<len(things) - 1 { center_of(things[i]).x == center_of(things[-1]).x }
    }
}

// Whether all are lines; a mix of lines and other things is refused, since a line has no one height.
fn alike_in_kind(things: list) = if len([t for t in things if is_line(t)]) in [
    0, len(things)
] then len(things) > 0 and is_line(things[0]) else refuse(
    "it takes lines, or points and things with centres, not both"
)

/// The lines run in the same direction, or in opposite ones.
///
/// ```aidl
/// drawing d {
///     a = line(fixed((0, 0)), fixed((60, 20)))
///     b = line((0, 10), length: 50, angle: guess(10deg))
///     constrain parallel(b, a)
/// }
/// ```
constraint parallel(lines: list) {
    for i in 0..<len(lines) - 1 { sine(lines[i], lines[-1]) == 0 }
}

/// The lines meet at a right angle; a line meets a circle or an arc so when it runs through the centre.
///
/// Curves that share an end are perpendicular there.
///
/// ```aidl
/// drawing d {
///     floor_line = line(fixed((0, 0)), fixed((60, 20)))
///     wall = line((30, 10), length: 40, angle: guess(95deg))
///     constrain {
///         coincident(wall.start, floor_line)
///         perpendicular(wall, floor_line)
///     }
/// }
/// ```
constraint perpendicular(a: line, b: line) { cosine(a, b) == 0 }
constraint perpendicular(a, b) {
    let joint = shared_end(ends_of(a), ends_of(b))
    if len(joint) > 0 {
        let v = along(a, joint[0])
        let w = along(b, joint[0])
        dot(v, w) / norm(v) / norm(w) == 0
    } else {
        crosses_squarely(a, b)
    }
}
constraint crosses_squarely(l: line, c: circle) { offset_from(c.center, l) == 0 }
constraint crosses_squarely(l: line, a: arc) { offset_from(a.center, l) == 0 }
constraint crosses_squarely(c: circle, l: line) { offset_from(c.center, l) == 0 }
constraint crosses_squarely(a: arc, l: line) { offset_from(a.center, l) == 0 }

/// Lines and points lie on one endless line.
///
/// ```aidl
/// drawing d {
///     a = line(fixed((0, 0)), fixed((30, 10)))
///     b = line((42, 18), length: 20, angle: guess(10deg))
///     p = (80, 20)
///     mark = circle(center: p, radius: 2)
///     constrain collinear(b, p, a)
/// }
/// ```
constraint collinear(things: list) {
    let lines = [i for i in 0..<len(things) if is_line(things[i])]
    if len(lines) > 0 {
        for i in 0..<len(things) { if i != lines[-1] { in_line(things[i], things[lines[-1]]) } }
    } else if len(things) == 2 {
        refuse("two points always lie on one line; name a third, or a line")
    } else {
        for i in 0..<len(things) - 2 {
            let from = center_of(things[-2])
            let way = center_of(things[-1]) - from
            cross(way, center_of(things[i]) - from) / norm(way) == 0
        }
    }
}
constraint in_line(a: line, b: line) {
    offset_from(a.start, b) == 0
    offset_from(a.end, b) == 0
}
constraint in_line(p, l: line) { offset_from(center_of(p), l) == 0 }

// --- Sizes -----------------------------------------------------------------------------------------

/// The same size: lengths of lines, radii of round things, the lengths that make a shape; or the same number.
///
/// Of structures the boxes have the same width and height.
///
/// ```aidl
/// drawing d {
///     a = circle(center: (0, 0), radius: guess(6))
///     b = circle(center: (30, 0), radius: 10)
///     r = rectangle(center: (0, 30), width: guess(12), height: guess(12))
///     s = rectangle(center: (30, 30), width: 20, height: 10)
///     constrain {
///         equal(a, b)
///         equal(r, s)
///     }
/// }
/// ```
constraint equal(things: peers) {
    for i in 0..<len(things) - 1 { like(things[i], things[-1]) }
}
constraint like(a: line, b: line) { a.length == b.length }
constraint like(a: line, b: arc) { a.length == b.length }
constraint like(a: arc, b: line) { a.length == b.length }
constraint like(a: circle, b: circle) { a.radius == b.radius }
constraint like(a: arc, b: arc) { a.radius == b.radius }
constraint like(a: arc, b: circle) { a.radius == b.radius }
constraint like(a: circle, b: arc) { a.radius == b.radius }
constraint like(a: ellipse, b: ellipse) {
    a.rx == b.rx
    a.ry == b.ry
}
constraint like(a: point, b: point) { a == b }
constraint like(a: structure, b: structure) {
    a.bb.width == b.bb.width
    a.bb.height == b.bb.height
}
constraint like(a: geometry, b: geometry) {
    if len(sizes(a)) > 0 and len(sizes(a)) == len(sizes(b)) {
        for p, q in zip(sizes(a), sizes(b)) { p == q }
    } else {
        refuse("they have no sizes in common; `same_size` compares their boxes")
    }
}
constraint like(a: length, b: length) { a == b }
constraint like(a: angle, b: angle) { a == b }
constraint like(a: number, b: number) { a == b }
constraint like(l: line, n: number) { refuse("a line and a number: write `l.length == 20`") }
constraint like(l: line, n: length) { refuse("a line and a number: write `l.length == 20`") }
constraint like(n: number, l: line) { refuse("a line and a number: write `l.length == 20`") }
constraint like(n: length, l: line) { refuse("a line and a number: write `l.length == 20`") }

/// The same length: of lines, arcs and whatever has a `length`.
///
/// ```aidl
/// drawing d {
///     a = line((0, 0), length: guess(20), angle: 0deg)
///     b = line((0, 10), length: guess(30), angle: 10deg)
///     c = line((0, 20), length: 40, angle: 20deg)
///     constrain equal_length(a, b, c)
/// }
/// ```
constraint equal_length(things: peers) {
    for i in 0..<len(things) - 1 { things[i].length == things[-1].length }
}

/// The same radius: of circles, arcs and whatever has a `radius`.
///
/// ```aidl
/// drawing d {
///     a = circle(center: (0, 0), radius: guess(6))
///     b = circle(center: (30, 0), radius: 10)
///     c = regular_polygon(center: (60, 0), radius: guess(7), sides: 6)
///     constrain equal_radius(a, c, b)
/// }
/// ```
constraint equal_radius(things: peers) {
    for i in 0..<len(things) - 1 { things[i].radius == things[-1].radius }
}

alias orthogonal = perpendicular
alias square_to = perpendicular
alias right_angle = perpendicular
alias at_right_angle = perpendicular
alias normal = perpendicular
alias normal_to = perpendicular
alias same_point = coincident
alias coincide = coincident
alias on = coincident
alias point_on = coincident
alias lies_upon = coincident
alias point_on_line = coincident
alias point_on_circle = coincident
alias point_on_curve = coincident
alias between_ends = on_segment
alias within_ends = on_segment
alias on_span = on_segment
alias level = horizontal
alias upright = vertical
alias aligned = collinear
alias colinear = collinear
alias same_line = collinear
alias same_center = concentric
alias same_centre = concentric
alias coaxial = concentric
alias parallel_to = parallel
alias at_midpoint = midpoint
alias midpoint_of = midpoint
alias same_length = equal_length
alias equal_lengths = equal_length
alias same_radius = equal_radius
alias equal_radii = equal_radius
alias equal_diameter = equal_radius
alias same_diameter = equal_radius
alias same = equal
alias equals = equal
alias congruent = equal
alias perpendicular_to = perpendicular
alias orthogonal_to = perpendicular
alias parallel_with = parallel
alias coincident_with = coincident
alias concentric_with = concentric
alias coaxial_with = concentric
alias same_center_as = concentric
alias collinear_with = collinear
alias equal_to = equal
alias same_radii = equal_radius
alias equal_diameters = equal_radius
alias same_diameters = equal_radius
alias same_lengths = equal_length
