// Mirror images: of points, curves, boxes and lists of them, about lines, points, axes and coordinates.

/// Mirror images of each other: about a line, a point, an axis (`x_axis`, `y_axis`, `axis: y`) or an x.
///
/// Two of a kind are images of each other, sizes and all; of things of two kinds (a hole and a circle, a rectangle
/// and a point) the centres are. Two lists are so by pairs. One thing alone is symmetric in itself; one list as a
/// whole, the first with the last, and so on inwards.
///
/// ```aidl
/// drawing d {
///     left_eye  = circle(center: (-20, 12), radius: guess(4))
///     right_eye = circle(center: (18, 10), radius: 6)
///     nose      = line((3, 0), length: 12, angle: 90deg)
///     constrain {
///         symmetric(left_eye, right_eye, about: y_axis)
///         symmetric(nose, about: y_axis)
///     }
/// }
/// ```
constraint symmetric(a: peer, b: peer, about: line) { image(a, b, about: about) }
constraint symmetric(a: peer, b: peer, about: point) { turned_image(a, b, about: about) }
constraint symmetric(a: peer, b: peer, about: length) { image(a, b, about: upright_through((about, 0))) }
constraint symmetric(a: peer, b: peer, about: text) { image(a, b, about: axis_of(about)) }
constraint symmetric(a: peer, b: peer, axis: text) { image(a, b, about: axis_of(axis)) }
constraint symmetric(a: peer, b: peer, about: point, axis: text) {
    image(
        a,
        b,
        about: if choice(axis, ["x", "y"]) == "x" then level_through(about) else upright_through(
            about
        )
    )
}
constraint symmetric(a: peer, b: peer, axis: length) { image(a, b, about: upright_through((axis, 0))) }
constraint symmetric(a: peer, b: peer, axis: line) { image(a, b, about: axis) }
constraint symmetric(a: peer, about: line) {
    if is_list(a) { own_images(a, about: about) } else { own_image(a, about: about) }
}
constraint symmetric(a: peer, about: text) { symmetric(a, about: axis_of(about)) }
constraint symmetric(a: peer, axis: text) { symmetric(a, about: axis_of(axis)) }
constraint symmetric(a: peer, axis: line) { symmetric(a, about: axis) }

// The axis that a word means, and the endless lines through a point.
fn axis_of(word: text) =
    if choice(word, ["x", "y"]) == "x" then level_through((0, 0)) else upright_through((0, 0))
fn level_through(p: point) = line(fixed(p), fixed(p + (1, 0)))
fn upright_through(p: point) = line(fixed(p), fixed(p + (0, 1)))

// The mirror image of a point, and how far another is from it as written.
fn image_of(p: point, about: line) = p - across(about) * (2 * offset_from(p, about))
fn across(l: line) = turned(l.end - l.start, 90deg) / l.length
fn mirror_error(a: point, b: point, about: line) = norm(written(image_of(a, about) - b))

// Whether two curves are images from start to start, as written, rather than from start to end.
fn keeps_sense(a, b, about: line) = mirror_error(a.start, b.start, about) + mirror_error(
    a.end, b.end, about
) <= mirror_error(a.start, b.end, about) + mirror_error(a.end, b.start, about)

// Whether an arc runs clockwise: then it lies to the left of the way from its start to its end.
fn is_clockwise(a: arc) = written(cross(a.end - a.start, a.midpoint - a.start)) > 0

constraint image(a: point, b: point, about: line) {
    offset_from((a + b) / 2, about) == 0
    dot(b - a, vector(about)) / about.length == 0
}
constraint image(a: line, b: line, about: line) {
    let same = keeps_sense(a, b, about)
    image(a.start, if same then b.start else b.end, about: about)
    image(a.end, if same then b.end else b.start, about: about)
}
constraint image(a: circle, b: circle, about: line) {
    image(a.center, b.center, about: about)
    a.radius == b.radius
}
constraint image(a: arc, b: arc, about: line) {
    let same = is_clockwise(a) != is_clockwise(b)
    let turn = 2 * about.angle
    image(a.center, b.center, about: about)
    a.radius == b.radius
    a.start_angle == turn - (if same then b.start_angle else b.end_angle)
    a.end_angle == turn - (if same then b.end_angle else b.start_angle)
}
constraint image(a: ellipse, b: ellipse, about: line) {
    let turn = 2 * about.angle - b.angle
    image(a.center, b.center, about: about)
    a.rx == b.rx
    a.ry == b.ry
    a.angle == nearest(a.angle, [turn, turn + 180deg])
}
constraint image(a: bezier, b: bezier, about: line) {
    let same = keeps_sense(a, b, about)
    image(a.p0, if same then b.p0 else b.p3, about: about)
    image(a.p1, if same then b.p1 else b.p2, about: about)
    image(a.p2, if same then b.p2 else b.p1, about: about)
    image(a.p3, if same then b.p3 else b.p0, about: about)
}
constraint image(a: list, b: list, about: line) {
    if len(a) == len(b) {
        for p, q in zip(a, b) { image(p, q, about: about) }
    } else {
        refuse("the two lists have different numbers of members")
    }
}
// Shapes and structures by their boxes.
constraint image(a: structure, b: structure, about: line) {
    image_of_box(a, b, about: about)
}
constraint image(a: geometry, b: geometry, about: line) {
    if is_primitive(a) or is_primitive(b) {
        image(center_of(a), center_of(b), about: about)
    } else {
        image_of_box(a, b, about: about)
    }
}
// Of things of two kinds only the centres are images.
constraint image(a, b, about: line) { image(center_of(a), center_of(b), about: about) }
constraint image_of_box(a: box, b: box, about: line) {
    image(a.center, b.center, about: about)
    same_size(a, b)
}
fn is_primitive(of) = false
fn is_primitive(p: point) = true
fn is_primitive(l: line) = true
fn is_primitive(c: circle) = true
fn is_primitive(a: arc) = true
fn is_primitive(e: ellipse) = true
fn is_primitive(b: bezier) = true

// Half a turn about a point.
constraint turned_image(a: point, b: point, about: point) { (a + b) / 2 == about }
constraint turned_image(a: line, b: line, about: point) {
    let same = norm(written(a.start + b.start - about * 2)) <= norm(
        written(a.start + b.end - about * 2)
    )
    (a.start + (if same then b.start else b.end)) / 2 == about
    (a.end + (if same then b.end else b.start)) / 2 == about
}
constraint turned_image(a: circle, b: circle, about: point) {
    (a.center + b.center) / 2 == about
    a.radius == b.radius
}
constraint turned_image(a: arc, b: arc, about: point) {
    let same = is_clockwise(a) == is_clockwise(b)
    (a.center + b.center) / 2 == about
    a.radius == b.radius
    a.start_angle == 180deg + (if same then b.start_angle else b.end_angle)
    a.end_angle == 180deg + (if same then b.end_angle else b.start_angle)
}
constraint turned_image(a: ellipse, b: ellipse, about: point) {
    (a.center + b.center) / 2 == about
    a.rx == b.rx
    a.ry == b.ry
    a.angle == nearest(a.angle, [b.angle, b.angle + 180deg])
}
constraint turned_image(a: bezier, b: bezier, about: point) {
    let same = norm(written(a.p0 + b.p0 - about * 2)) <= norm(written(a.p0 + b.p3 - about * 2))
    (a.p0 + (if same then b.p0 else b.p3)) / 2 == about
    (a.p1 + (if same then b.p1 else b.p2)) / 2 == about
    (a.p2 + (if same then b.p2 else b.p1)) / 2 == about
    (a.p3 + (if same then b.p3 else b.p0)) / 2 == about
}
constraint turned_image(a: list, b: list, about: point) {
    if len(a) == len(b) {
        for p, q in zip(a, b) { turned_image(p, q, about: about) }
    } else {
        refuse("the two lists have different numbers of members")
    }
}
constraint turned_image(a: structure, b: structure, about: point) {
    turned_box(a, b, about: about)
}
constraint turned_image(a: geometry, b: geometry, about: point) {
    if is_primitive(a) or is_primitive(b) {
        turned_image(center_of(a), center_of(b), about: about)
    } else {
        turned_box(a, b, about: about)
    }
}
constraint turned_image(a, b, about: point) {
    turned_image(center_of(a), center_of(b), about: about)
}
constraint turned_box(a: box, b: box, about: point) {
    (a.center + b.center) / 2 == about
    same_size(a, b)
}

// Symmetric in itself: the ends of a curve are images of each other, a list is from both its ends, and of
// anything else the centre lies on the axis.
constraint own_image(p: point, about: line) { offset_from(p, about) == 0 }
constraint own_image(l: line, about: line) {
    if abs(written(sine(l, about))) < abs(written(cosine(l, about))) {
        in_line(l, about)  // it runs along the axis rather than across
    } else {
        image(l.start, l.end, about: about)
    }
}
constraint own_image(a: arc, about: line) { image(a.start, a.end, about: about) }
constraint own_image(b: bezier, about: line) {
    image(b.p0, b.p3, about: about)
    image(b.p1, b.p2, about: about)
}
constraint own_image(of: box, about: line) { offset_from(of.center, about) == 0 }
constraint own_images(things: list, about: line) {
    for i in 0..<len(things) {
        let j = len(things) - 1 - i
        if i < j { image(things[i], things[j], about: about) }
        if i == j { own_image(things[i], about: about) }
    }
}

alias symmetrical = symmetric
alias symmetry = symmetric
alias symmetric_about = symmetric
alias mirror_symmetric = symmetric
