// Outlines of straight edges, given by their corners or regular.

/// A closed outline of straight edges through the points.
///
/// Its corners are `corner[0]` and so on, its edges `edge[i]` run from `corner[i]` to the next.
///
/// ```aidl
/// solid roof { body = polygon([(0, 0), (60, 0), (60, 10), (30, 30), (0, 10)]) }
/// ```
shape polygon(points: points) {
    assert len(points) >= 3, "a polygon has at least three corners"
    for i in 0..<len(points) {
        corner[i] = points[i]
        edges[i] = line(points[i], points[(i + 1) % len(points)])
    }
    let edge = edges
    let corners = corner
}

/// With `sides` and a `radius` it is a `regular_polygon`.
fn polygon(
    center: point = (0, 0), radius: length, sides: integer, angle = 0deg, rotatable = false
) = regular_polygon(center, radius, sides, angle, rotatable)

/// Straight edges through the points, not closed.
///
/// ```aidl
/// drawing crack { mark = polyline([(0, 0), (10, 12), (18, 8), (30, 24)]) }
/// ```
shape polyline(points: points) {
    assert len(points) >= 2, "a polyline has at least two points"
    for i in 0..<len(points) - 1 {
        edges[i] = line(points[i], points[i + 1])
    }
    let edge = edges
    let corner = points
    let corners = points
    let start = points[0]
    let end = points[-1]
}

/// A polygon of equal sides and angles, by the radius of its corners, its side, or its inner radius.
///
/// The first corner is at `angle`, `corner[i]` and `edge[i]` go on counter-clockwise. `across_flats`, from side to
/// side, is for an even number of sides.
///
/// Lies with a corner on the right; `center` is that of its corners.
///
/// ```aidl
/// solid nut {
///     body = regular_polygon(sides: 6, across_flats: 13)
///     hole thread { rim = circle(center: origin, radius: 4) }
/// }
/// ```
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
    let edge = edges
    let corners = corner
    let side = 2 * radius * sin(180deg / sides)
    let inradius = radius * cos(180deg / sides)
    let across_flats = 2 * inradius
}
fn regular_polygon(
    center: point = (0, 0),
    diameter: length,
    sides: integer,
    angle: angle = 0deg,
    rotatable: bool = false
) = regular_polygon(center, diameter / 2, sides, angle, rotatable)
fn regular_polygon(
    center: point = (0, 0),
    side: length,
    sides: integer,
    angle: angle = 0deg,
    rotatable: bool = false
) = regular_polygon(center, side / (2 * sin(180deg / sides)), sides, angle, rotatable)
fn regular_polygon(
    center: point = (0, 0),
    inradius: length,
    sides: integer,
    angle: angle = 0deg,
    rotatable: bool = false
) = regular_polygon(center, inradius / cos(180deg / sides), sides, angle, rotatable)
fn regular_polygon(
    center: point = (0, 0),
    across_flats: length,
    sides: integer,
    angle: angle = 0deg,
    rotatable: bool = false
) = regular_polygon(center, across_flats / (2 * cos(180deg / sides)), sides, angle, rotatable)

/// A regular polygon of five sides; with the default angle its first corner is at the top.
///
/// Lies tip up; `center` is that of its corners.
///
/// ```aidl
/// solid badge { body = pentagon(side: 20) }
/// ```
fn pentagon(center: point = (0, 0), radius: length, angle: angle = 90deg, rotatable: bool = false) =
    regular_polygon(center: center, radius: radius, sides: 5, angle: angle, rotatable: rotatable)
fn pentagon(
    center: point = (0, 0), diameter: length, angle: angle = 90deg, rotatable: bool = false
) = regular_polygon(
    center: center, diameter: diameter, sides: 5, angle: angle, rotatable: rotatable
)
fn pentagon(center: point = (0, 0), side: length, angle: angle = 90deg, rotatable: bool = false) =
    regular_polygon(center: center, side: side, sides: 5, angle: angle, rotatable: rotatable)
fn pentagon(
    center: point = (0, 0), inradius: length, angle: angle = 90deg, rotatable: bool = false
) = regular_polygon(
    center: center, inradius: inradius, sides: 5, angle: angle, rotatable: rotatable
)

/// A regular polygon of six sides; with the default angle its first corner is on the right.
///
/// ```aidl
/// solid bolt_head { body = hexagon(across_flats: 13) }
/// ```
fn hexagon(center: point = (0, 0), radius: length, angle: angle = 0deg, rotatable: bool = false) =
    regular_polygon(center: center, radius: radius, sides: 6, angle: angle, rotatable: rotatable)
fn hexagon(
    center: point = (0, 0), diameter: length, angle: angle = 0deg, rotatable: bool = false
) = regular_polygon(
    center: center, diameter: diameter, sides: 6, angle: angle, rotatable: rotatable
)
fn hexagon(center: point = (0, 0), side: length, angle: angle = 0deg, rotatable: bool = false) =
    regular_polygon(center: center, side: side, sides: 6, angle: angle, rotatable: rotatable)
fn hexagon(
    center: point = (0, 0), inradius: length, angle: angle = 0deg, rotatable: bool = false
) = regular_polygon(
    center: center, inradius: inradius, sides: 6, angle: angle, rotatable: rotatable
)
fn hexagon(
    center: point = (0, 0), across_flats: length, angle: angle = 0deg, rotatable: bool = false
) = regular_polygon(
    center: center, across_flats: across_flats, sides: 6, angle: angle, rotatable: rotatable
)

/// A regular polygon of eight sides; with the default angle it lies on a level side.
///
/// ```aidl
/// solid stop_sign { plate = octagon(across_flats: 60) }
/// ```
fn octagon(
    center: point = (0, 0), radius: length, angle: angle = 22.5deg, rotatable: bool = false
) = regular_polygon(center: center, radius: radius, sides: 8, angle: angle, rotatable: rotatable)
fn octagon(
    center: point = (0, 0), diameter: length, angle: angle = 22.5deg, rotatable: bool = false
) = regular_polygon(
    center: center, diameter: diameter, sides: 8, angle: angle, rotatable: rotatable
)
fn octagon(center: point = (0, 0), side: length, angle: angle = 22.5deg, rotatable: bool = false) =
    regular_polygon(center: center, side: side, sides: 8, angle: angle, rotatable: rotatable)
fn octagon(
    center: point = (0, 0), inradius: length, angle: angle = 22.5deg, rotatable: bool = false
) = regular_polygon(
    center: center, inradius: inradius, sides: 8, angle: angle, rotatable: rotatable
)
fn octagon(
    center: point = (0, 0), across_flats: length, angle: angle = 22.5deg, rotatable: bool = false
) = regular_polygon(
    center: center, across_flats: across_flats, sides: 8, angle: angle, rotatable: rotatable
)

/// A star with `points` tips on one circle and its notches on another; the first tip is at `angle`.
///
/// With one `radius` its edges run straight from tip to tip, as in a pentagram.
///
/// Lies tip up; `center` is that of its tips.
///
/// ```aidl
/// solid ornament { body = star(points: 5, outer_radius: 30, inner_radius: 14) }
/// ```
shape star(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    points: integer = 5,
    angle: turn = 90deg,
    rotatable: bool = false
) {
    assert points >= 2, "a star has at least two tips"
    assert inner_radius < outer_radius, "the notches of a star lie nearer to its center than its tips"
    for i in 0..<points {
        tip[i] = center + polar(outer_radius, angle + 360deg / points * i)
        notch[i] = center + polar(inner_radius, angle + 360deg / points * (i + 0.5))
    }
    for i in 0..<points {
        falling[i] = line(tip[i], notch[i])
        rising[i] = line(notch[i], tip[(i + 1) % points])
    }
}
fn star(center: point = (0, 0), radius: length, points: integer = 5, angle: angle = 90deg) =
    star(center, radius, radius * cos(360deg / points) / cos(180deg / points), points, angle)

alias ngon = regular_polygon
alias hex = hexagon
