// Numbers and points: what everything else is written with.

let pi = 3.141592653589793

// --- Points as vectors ---------------------------------------------------------------------------

/// The point at a distance and a direction from the origin.
fn polar(radius: length, angle: angle) = (radius * cos(angle), radius * sin(angle))

/// The length of a vector.
fn norm(v: point) = hypot(v.x, v.y)

/// The scalar product; 0 when the two are perpendicular.
fn dot(a: point, b: point) = a.x * b.x + a.y * b.y

/// The area spanned by two vectors, positive when b is counter-clockwise of a; 0 when they are parallel.
fn cross(a: point, b: point) = a.x * b.y - a.y * b.x

/// The vector of the same direction and length 1 mm.
fn unit(v: point) = (v.x / norm(v) * 1mm, v.y / norm(v) * 1mm)

/// The point a share of the way from a to b: 0 is a, 1 is b.
fn lerp(a: point, b: point, t: number) = a + (b - a) * t

/// The middle of two points.
fn midpoint(a: point, b: point) = (a + b) / 2
fn midpoint(l: line) = l.midpoint

/// A vector turned counter-clockwise about the origin.
fn turned(v: point, angle: angle) = (v.x * cos(angle) - v.y * sin(angle), v.x * sin(
    angle
) + v.y * cos(angle))

/// The vector from the start of a line to its end, and the same 1 mm long.
fn vector(l: line) = l.end - l.start
fn direction(l: line) = unit(l.end - l.start)

/// An angle as a plain number of radians.
fn radians(angle: angle) = angle / 1deg * pi / 180

/// The centre of the circle through three points.
fn circumcenter(a: point, b: point, c: point) = a + circumcenter_from(b - a, c - a)
fn circumcenter_from(b: point, c: point) = ((c.y * dot(b, b) - b.y * dot(c, c)) / (2 * cross(
    b,
    c
)), (b.x * dot(c, c) - c.x * dot(b, b)) / (2 * cross(b, c)))

// --- Primitives by other means -------------------------------------------------------------------

/// The circle through three points.
fn circle(a: point, b: point, c: point) = circle(
    center: circumcenter(a, b, c),
    radius: norm(a - circumcenter(a, b, c))
)

/// The arc through three points, in the order given.
fn arc(start: point, mid: point, end: point) = arc(
    center: circumcenter(start, mid, end),
    start: start,
    end: end,
    clockwise: cross(mid - start, end - start) < 0
)
