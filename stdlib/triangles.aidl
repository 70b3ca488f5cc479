// Triangles.

/// A triangle, by its corners, its base and height, or its sides and angles.
///
/// Its corners are `a`, `b`, `c` counter-clockwise and its edges `ab`, `bc`, `ca`; it has a `centroid` and an
/// `incenter`. One with a `base` lies level and has `bottom_left`, `bottom_right`, `apex`, `bottom`, `right` and
/// `left` as well. A side and an angle have the names of the corners: `triangle(ab: 40, angle_a: 60deg, ca: 30)`.
///
/// Lies on its base; by sides `ab` runs to the right from `a`, by one `side` `center` is the centroid.
///
/// ```aidl
/// solid gusset {
///     body = triangle(ab: 40, bc: 50, ca: 30)
///     hole bore { rim = circle(center: (0, 0), radius: 5) }
///     constrain bore.rim.center == body.incenter
/// }
/// ```
shape triangle(a: point, b: point, c: point) {
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
    let center = centroid
}

/// Upright about the centre of its box, with two equal sides.
shape triangle(
    center: point = (0, 0),
    base: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    bottom_left = center + turned((-base / 2, -height / 2), angle)
    bottom_right = center + turned((base / 2, -height / 2), angle)
    apex = center + turned((0, height / 2), angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, apex)
    left = line(apex, bottom_left)
    let a = bottom_left
    let b = bottom_right
    let c = apex
    let ab = bottom
    let bc = right
    let ca = left
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}

/// Upright by the middle of its base, about which it turns.
shape triangle(
    bottom_center: point, base: length, height: length, angle: turn = 0deg, rotatable: bool = false
) {
    center = bottom_center + turned((0, height / 2), angle)
    bottom_left = bottom_center + turned((-base / 2, 0), angle)
    bottom_right = bottom_center + turned((base / 2, 0), angle)
    apex = bottom_center + turned((0, height), angle)
    bottom = line(bottom_left, bottom_right)
    right = line(bottom_right, apex)
    left = line(apex, bottom_left)
    let a = bottom_left
    let b = bottom_right
    let c = apex
    let ab = bottom
    let bc = right
    let ca = left
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}

/// By its sides; `angle` is the direction of the first. Of two sides and the angle between them, or one side and
/// the angles at its ends, too.
fn triangle(a: point = (0, 0), ab: length, bc: length, ca: length, angle = 0deg) =
    triangle(a, length_ab: ab, length_bc: bc, length_ca: ca, angle: angle)
fn triangle(a: point = (0, 0), ab: length, angle_a: angle, ca: length, angle = 0deg) =
    triangle(a, length_ab: ab, angle_a: angle_a, length_ca: ca, angle: angle)
fn triangle(a: point = (0, 0), angle_a: angle, ab: length, angle_b: angle, angle = 0deg) =
    triangle(a, angle_a: angle_a, length_ab: ab, angle_b: angle_b, angle: angle)

/// Sides `a`, `b`, `c` as in a textbook: each is opposite to the corner of its name.
fn triangle(a: length, b: length, c: length) = triangle(length_ab: c, length_bc: a, length_ca: b)

/// Of three equal sides, see `equilateral_triangle`.
fn triangle(center: point = (0, 0), side: length, angle = 0deg, rotatable = false) =
    equilateral_triangle(center: center, side: side, angle: angle, rotatable: rotatable)

// What these stand on: a size that is also the name of an edge is called `length_ab`.
shape triangle(
    a: point = (0, 0),
    length_ab: length,
    length_bc: length,
    length_ca: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert max(length_ab, length_bc, length_ca) * 2 < length_ab + length_bc + length_ca,
        "each side of a triangle is shorter than the other two together"
    let along = (length_ab ^ 2 + length_ca ^ 2 - length_bc ^ 2) / (2 * length_ab)
    b = a + polar(length_ab, angle)
    c = a + turned((along, sqrt(length_ca ^ 2 - along ^ 2)), angle)
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}
shape triangle(
    a: point = (0, 0),
    length_ab: length,
    angle_a: angle,
    length_ca: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert min(length_ab, length_ca) >= 0, "the sides of a triangle are not negative"
    assert 0deg < angle_a < 180deg, "the angles of a triangle are between 0 and 180 degrees"
    b = a + polar(length_ab, angle)
    c = a + polar(length_ca, angle + angle_a)
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}
shape triangle(
    a: point = (0, 0),
    angle_a: angle,
    length_ab: length,
    angle_b: angle,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert angle_a > 0deg and angle_b > 0deg and angle_a + angle_b < 180deg,
        "two angles of a triangle are together less than 180 degrees"
    b = a + polar(length_ab, angle)
    c = a + polar(length_ab * sin(angle_b) / sin(angle_a + angle_b), angle + angle_a)
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}

// Where the bisectors of the angles meet: the centre of the largest circle inside.
fn incenter_of(a: point, b: point, c: point) = (a * norm(c - b) + b * norm(a - c) + c * norm(
    b - a
)) / (norm(c - b) + norm(a - c) + norm(b - a))

/// A triangle with a right angle at `corner`, one leg to the right (`width`) and one up (`height`).
///
/// `angle` turns it about that corner. Its edges are `bottom`, `left` and `hypotenuse`.
///
/// Lies with its right angle at the lower left, held there.
///
/// ```aidl
/// solid shelf_support { body = right_triangle(corner: (0, 0), width: 40, height: 60) }
/// ```
shape right_triangle(
    corner: point = (0, 0),
    width: length,
    height: length,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    a = corner
    b = corner + polar(width, angle)
    c = corner + polar(height, angle + 90deg)
    bottom = line(a, b)
    hypotenuse = line(b, c)
    left = line(c, a)
    let ab = bottom
    let bc = hypotenuse
    let ca = left
    let centroid = (a + b + c) / 3
    let incenter = incenter_of(a, b, c)
}
fn right_triangle(base: length, height: length, corner: point = (0, 0), angle = 0deg) =
    right_triangle(corner: corner, width: base, height: height, angle: angle)

/// A triangle of three equal sides about its centre; with `angle` 0 it lies on a level side.
///
/// Lies on a side; `center` is the centroid.
///
/// ```aidl
/// solid sign { plate = equilateral_triangle(side: 50) }
/// ```
shape equilateral_triangle(
    center: point = (0, 0), side: length, angle: turn = 0deg, rotatable: bool = false
) {
    let radius = side / sqrt(3)
    let inradius = radius / 2
    a = center + polar(radius, angle + 210deg)
    b = center + polar(radius, angle + 330deg)
    c = center + polar(radius, angle + 90deg)
    ab = line(a, b)
    bc = line(b, c)
    ca = line(c, a)
    let bottom = ab
    let right = bc
    let left = ca
    let apex = c
}

alias isosceles_triangle = triangle
alias right_angled_triangle = right_triangle
