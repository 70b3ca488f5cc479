// Relations that say of two things what `mirror` makes of one. The operations themselves are built in.

/// One thing is the mirror image of another: points, lines, arcs, circles, curves, boxes, or lists of them.
///
/// `about` is a line, an axis or a point. The first thing is placed and the second one held; ends of lines and
/// Béziers are matched as they lie nearest. Of compound shapes and structures the boxes mirror each other, of things
/// of two kinds the centres.
///
/// ```aidl
/// drawing ears {
///     construction axis = line((0, -20), (0, 20))
///     right = circle(center: (25, 5), radius: 8)
///     left = circle(center: (-20, 0), radius: guess(6))
///     constrain mirror_of(left, right, about: axis)
/// }
/// ```
constraint mirror_of(a: point, b: point, about) { a == mirror(b, about: about) }
constraint mirror_of(a: line, b: line, about) {
    let image = mirror(b, about: about)
    let ends = matched([a.start, a.end], [image.start, image.end])
    a.start == ends[0]
    a.end == ends[1]
}
constraint mirror_of(a: circle, b: circle, about) {
    a.center == mirror(b.center, about: about)
    a.radius == b.radius
}
constraint mirror_of(a: arc, b: arc, about) {
    let image = mirror(b, about: about)
    let is_reversed = is_clockwise(a) != is_clockwise(image)
    a.center == image.center
    a.radius == b.radius
    a.start_angle == (if is_reversed then image.end_angle else image.start_angle)
    a.end_angle == (if is_reversed then image.start_angle else image.end_angle)
}
constraint mirror_of(a: ellipse, b: ellipse, about) {
    let image = mirror(b, about: about)
    a.center == image.center
    a.rx == b.rx
    a.ry == b.ry
    a.angle == nearest(a.angle, [image.angle, image.angle + 180deg])
}
constraint mirror_of(a: bezier, b: bezier, about) {
    let image = mirror(b, about: about)
    let controls = matched([a.p0, a.p1, a.p2, a.p3], [image.p0, image.p1, image.p2, image.p3])
    a.p0 == controls[0]
    a.p1 == controls[1]
    a.p2 == controls[2]
    a.p3 == controls[3]
}
constraint mirror_of(a: structure, b: structure, about) { mirrored_box(a, b, about: about) }
constraint mirror_of(a: geometry, b: geometry, about) {
    if is_primitive(a) or is_primitive(b) {
        mirror_of(center_of(a), center_of(b), about: about)
    } else {
        mirrored_box(a, b, about: about)
    }
}
constraint mirror_of(a, b, about) { mirror_of(center_of(a), center_of(b), about: about) }
constraint mirrored_box(a: box, b: box, about) {
    a.center == mirror(b.center, about: about)
    a.width == b.width
    a.height == b.height
}
constraint mirror_of(a: list, b: list, about) {
    len(a) == len(b)
    for i in 0..<len(a) { mirror_of(a[i], b[i], about: about) }
}

// Points in the order, from the front or from the back, in which they were written nearer to others.
fn matched(a: list, b: list) =
    if distances(a, b) <= distances(a, reversed(b)) then b else reversed(b)
fn distances(a: list, b: list) = sum([norm(written(a[i] - b[i])) for i in 0..<len(a)])

alias mirrored_from = mirror_of
alias mirror_image = mirror_of
alias mirror_image_of = mirror_of
