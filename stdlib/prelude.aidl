// Numbers and points: what everything else is written with.

/// The circumference of a circle over its diameter.
///
/// ```aidl
/// solid disc {
///     rim = circle(center: origin, radius: 20)
///     assert perimeter(disc) == 2 * pi * 20
/// }
/// ```
let pi = 3.141592653589793

// --- Points as vectors ---------------------------------------------------------------------------

/// The point at a distance and a direction from the origin.
///
/// ```aidl
/// solid dial {
///     plate = circle(center: origin, radius: 28)
///     for i in 0..9 {
///         hole finger[i] { rim = circle(center: fixed(polar(20, 36deg * i)), radius: 4) }
///     }
/// }
/// ```
fn polar(radius: length, angle: angle) = (radius * cos(angle), radius * sin(angle))

/// The length of a vector.
///
/// ```aidl
/// drawing d {
///     a = (0, 0)
///     b = (30, 40)
///     way = line(a, b)
///     assert norm(b - a) == way.length
/// }
/// ```
fn norm(v: point) = hypot(v.x, v.y)

/// The scalar product; 0 when the two are perpendicular.
///
/// ```aidl
/// drawing d {
///     arm = line(fixed((0, 0)), fixed((40, 15)))
///     post = line(arm.start, (-10, 30))
///     constrain dot(vector(post), vector(arm)) == 0
/// }
/// ```
fn dot(a: point, b: point) = a.x * b.x + a.y * b.y

/// The area spanned by two vectors, positive when b is counter-clockwise of a; 0 when they are parallel.
///
/// ```aidl
/// drawing d {
///     arm = line(fixed((0, 0)), fixed((40, 15)))
///     rail = line((5, 20), (40, 30))
///     constrain cross(vector(rail), vector(arm)) == 0
/// }
/// ```
fn cross(a: point, b: point) = a.x * b.y - a.y * b.x

/// The vector of the same direction and length 1 mm.
///
/// ```aidl
/// drawing d {
///     stem = line(fixed((0, 0)), fixed((30, 20)))
///     berry = circle(center: (35, 25), radius: 5)
///     constrain berry.center == stem.end + unit(vector(stem)) * 5      // the stem ends at its rim
/// }
/// ```
fn unit(v: point) = (v.x / norm(v) * 1mm, v.y / norm(v) * 1mm)

/// What lies a share of the way from a to b, which are points or numbers: 0 is a, 1 is b.
///
/// ```aidl
/// drawing ladder {
///     left = line((0, 0), (10, 60))
///     right = line((40, 0), (30, 60))
///     for i in 1..4 { rung[i] = line(lerp(left.start, left.end, i / 5), lerp(right.start, right.end, i / 5)) }
/// }
/// ```
fn lerp(a: point, b: point, t: number) = a + (b - a) * t
/// Of two numbers of one kind: lengths, angles, plain numbers.
fn lerp(a, b, t: number) = a + (b - a) * t

/// The middle of two points.
fn midpoint(a: point, b: point) = (a + b) / 2
fn midpoint(l: line) = l.midpoint

/// A vector turned counter-clockwise about the origin.
///
/// ```aidl
/// drawing flag {
///     pole = line((0, 0), (10, 60))
///     upper = line(pole.end, pole.end + turned(vector(pole), -90deg) / 2)
///     lower = line(lerp(pole.start, pole.end, 0.6), lerp(pole.start, pole.end, 0.6) + turned(vector(pole), -90deg) / 2)
///     hem = line(upper.end, lower.end)
/// }
/// ```
fn turned(v: point, angle: angle) =
    (v.x * cos(angle) - v.y * sin(angle), v.x * sin(angle) + v.y * cos(angle))

/// The vector from the start of a line to its end.
///
/// ```aidl
/// drawing d {
///     edge = line((0, 0), (40, 10))
///     copy_ = line((0, 20), (0, 20) + vector(edge))
///     assert copy_.length == edge.length
/// }
/// ```
fn vector(l: line) = l.end - l.start

/// The direction of a line, as a vector 1 mm long.
///
/// ```aidl
/// drawing d {
///     road = line(fixed((0, 0)), fixed((60, 25)))
///     for i in 0..3 {
///         lamp[i] = circle(center: road.start + direction(road) * (10 + 15 * i), radius: 3)
///     }
/// }
/// ```
fn direction(l: line) = unit(l.end - l.start)

/// An angle as a plain number of radians.
///
/// ```aidl
/// solid slice {
///     body = sector(center: origin, radius: 30, start_angle: 20deg, end_angle: 110deg)
///     assert body.rim.length == 30 * radians(90deg)
/// }
/// ```
fn radians(angle: angle) = angle / 1deg * pi / 180

/// The centre of the circle through three points.
///
/// ```aidl
/// drawing d {
///     a = (0, 0)
///     b = (50, 0)
///     c = (15, 35)
///     ab = line(a, b)
///     bc = line(b, c)
///     ca = line(c, a)
///     pin = circle(center: circumcenter(a, b, c), radius: 2)
///     around = circle(a, b, c)
/// }
/// ```
fn circumcenter(a: point, b: point, c: point) = a + circumcenter_from(b - a, c - a)

// The same, seen from the first point.
fn circumcenter_from(b: point, c: point) = ((c.y * dot(b, b) - b.y * dot(c, c)) / (2 * cross(
    b, c
)), (b.x * dot(c, c) - c.x * dot(b, b)) / (2 * cross(b, c)))

// --- Primitives by other means -------------------------------------------------------------------

/// The circle through three points.
fn circle(a: point, b: point, c: point) =
    circle(center: circumcenter(a, b, c), radius: norm(a - circumcenter(a, b, c)))

/// The arc from one point over another, which is named, to a third. Three points without names are centre, start and end.
fn arc(start: point, end: point, mid: point) = arc(
    center: circumcenter(start, mid, end),
    start: start,
    end: end,
    clockwise: cross(written(mid - start), written(end - start)) < 0
)
