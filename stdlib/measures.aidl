// Measures: numbers to compare, as in `distance(a, b) == 18`, and calls that set them, `distance(a, b, 18)`.

// How far a point lies to the left of a line, negative to the right.
fn offset_from(p: point, l: line) = cross(l.end - l.start, p - l.start) / l.length

/// How far apart two things are: points, centres of things, or perpendicular to an endless line.
///
/// The value may stand in the call, which also takes `at_least` and `at_most`. `clearance` measures outlines.
/// With an outline to go `along`, it is the way on it, the shorter one, between the places nearest to the two.
///
/// ```aidl
/// drawing d {
///     wall = line(fixed((0, 0)), fixed((80, 0)))
///     a = circle(center: (20, 12), radius: 6)
///     b = circle(center: (55, 15), radius: 6)
///     constrain {
///         distance(a, wall) == 20
///         distance(b, wall) == 20
///         distance(b, a, 40)
///     }
/// }
/// ```
fn distance(a, b) = norm(center_of(b) - center_of(a))
fn distance(a, l: line) = abs(offset_from(center_of(a), l))
fn distance(l: line, a) = abs(offset_from(center_of(a), l))
fn distance(a: line, b: line) = abs(offset_from(b.midpoint, a))
fn distance(a, b, along) = way_between(center_of(a), center_of(b), along)
constraint distance(a, b, value: length) { distance(a, b) == value }
constraint distance(a, b, at_least: length) { distance(a, b) >= at_least }
constraint distance(a, b, at_most: length) { distance(a, b) <= at_most }
constraint distance(a, b, at_least: length, at_most: length) {
    at_least <= distance(a, b) <= at_most
}

/// How far apart two points, or the centres of two things, are from left to right.
///
/// ```aidl
/// drawing d {
///     a = circle(center: fixed((0, 0)), radius: 6)
///     b = circle(center: (35, 12), radius: 6)
///     constrain horizontal_distance(b, a) == 40
/// }
/// ```
fn horizontal_distance(a, b) = abs(center_of(b).x - center_of(a).x)
constraint horizontal_distance(a, b, value: length) { horizontal_distance(a, b) == value }
constraint horizontal_distance(a, b, at_least: length) { horizontal_distance(a, b) >= at_least }
constraint horizontal_distance(a, b, at_most: length) { horizontal_distance(a, b) <= at_most }

/// How far apart two points, or the centres of two things, are from bottom to top.
///
/// ```aidl
/// drawing d {
///     a = circle(center: fixed((0, 0)), radius: 6)
///     b = circle(center: (35, 12), radius: 6)
///     constrain vertical_distance(b, a, 20)
/// }
/// ```
fn vertical_distance(a, b) = abs(center_of(b).y - center_of(a).y)
constraint vertical_distance(a, b, value: length) { vertical_distance(a, b) == value }
constraint vertical_distance(a, b, at_least: length) { vertical_distance(a, b) >= at_least }
constraint vertical_distance(a, b, at_most: length) { vertical_distance(a, b) <= at_most }

/// The room between two boxes: 0 when they touch or overlap.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: fixed((0, 0)), width: 20, height: 10)
///     b = rectangle(center: (30, 2), width: 20, height: 10)
///     constrain b.right_of(a, gap: 4)
///     assert gap(a, b) == 4
/// }
/// ```
fn gap(a: box, b: box) =
    hypot(max(0, a.left - b.right, b.left - a.right), max(0, a.bottom - b.top, b.bottom - a.top))

/// The angle between two lines, at the middle of three points, or of one line, or whatever has an `angle`, to the x axis.
///
/// As a constraint it takes the reading nearest to the first guesses: either way round, and for lines either
/// end. `ccw: true` states it counter-clockwise from a to b; `at_most` and `at_least`, or `<=` and `>=`, bound it.
///
/// ```aidl
/// drawing d {
///     base = line(fixed((0, 0)), fixed((60, 0)))
///     arm  = line(base.start, length: 40, angle: guess(50deg))
///     tip  = (60, 50)
///     flag = circle(center: tip, radius: 3)
///     constrain {
///         angle(arm, base) == 30deg
///         angle(tip, base.end, base.start) == 100deg
///     }
/// }
/// ```
fn angle(a: line, b: line) = b.angle - a.angle
fn angle(l) = l.angle
fn angle(a: point, corner: point, b: point) = abs(corner_angle(a, corner, b))
constraint angle(a: line, b: line, value: angle) {
    angle(a, b) == nearest(angle(a, b), [value, -value, 180deg - value, value - 180deg])
}
constraint angle(a: line, b: line, value: angle, ccw: bool) {
    angle(a, b) == (if ccw then value else -value)
}
constraint angle(a: line, b: line, at_most: angle) {
    opening(a, b, way_like(at_most, a, b)) <= at_most
}
constraint angle(a: line, b: line, at_least: angle) {
    opening(a, b, way_like(at_least, a, b)) >= at_least
}
constraint angle(l: line, value: angle) {
    l.angle == nearest(l.angle, [value, value - 180deg])
}
constraint angle(of, value: angle) { of.angle == value }
constraint angle(a: point, corner: point, b: point, value: angle) {
    corner_angle(a, corner, b) == nearest(corner_angle(a, corner, b), [value, -value])
}

// How far two lines open, 0 to 180 degrees: from end to end, or with `way` -1 from the end of one to the start of
// the other.
fn opening(a: line, b: line, way: number) =
    atan2(abs(cross(vector(a), vector(b))), way * dot(vector(a), vector(b)))

// The way in which two lines, as written, open as an angle does: sharp or blunt.
fn way_like(bound: angle, a: line, b: line) =
    if written((90deg - bound) * dot(vector(a), vector(b))) >= 0 then 1 else -1

// The angle from one arm of a corner to the other, counter-clockwise, at most half a turn either way.
fn corner_angle(a: point, corner: point, b: point) =
    atan2(cross(a - corner, b - corner), dot(a - corner, b - corner))

/// The length of a line, an arc, or whatever has a `length`.
///
/// ```aidl
/// drawing d {
///     a = line((0, 0), length: guess(20), angle: 20deg)
///     b = arc(center: (0, 30), radius: 20, start_angle: 0deg, end_angle: guess(60deg))
///     constrain {
///         length(a, 45)
///         length(b) == 30
///     }
/// }
/// ```
fn length(of) = of.length
constraint length(of, value: length) { of.length == value }

/// The radius of a circle, an arc, or whatever has a `radius`.
///
/// ```aidl
/// drawing d {
///     c = circle(center: (0, 0), radius: guess(12))
///     constrain radius(c) == 18
/// }
/// ```
fn radius(of) = of.radius
constraint radius(of, value: length) { of.radius == value }

/// Twice the radius.
///
/// ```aidl
/// drawing d {
///     c = circle(center: (0, 0), radius: guess(12))
///     constrain diameter(c, 30)
/// }
/// ```
fn diameter(of) = of.radius * 2
constraint diameter(of, value: length) { of.radius * 2 == value }

alias dist = distance
alias x_distance = horizontal_distance
alias distance_x = horizontal_distance
alias y_distance = vertical_distance
alias distance_y = vertical_distance
alias angle_between = angle
alias set_angle = angle
alias orientation = angle
alias rotation = angle
alias set_rotation = angle
alias tilt = angle
alias tilted = angle
