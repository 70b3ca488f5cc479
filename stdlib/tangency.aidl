// Curves that touch: at the end they share, or wherever they meet.

/// The curves touch without crossing: at the end they share, if there is one.
///
/// Which side, and from inside or outside, follows from the first guesses; `inside: true` states it of two
/// round things. Of several things, each touches the last.
///
/// ```aidl
/// drawing d {
///     ground = line(fixed((0, 0)), fixed((80, 0)))
///     wheel  = circle(center: (20, 18), radius: 15)
///     ball   = circle(center: (55, 12), radius: 8)
///     constrain {
///         tangent(wheel, ground)
///         tangent(ball, ground)
///         tangent(ball, wheel)
///     }
/// }
/// ```
constraint tangent(things: list) {
    for i in 0..<len(things) - 1 {
        let joint = shared_end(ends_of(things[i]), ends_of(things[-1]))
        if len(joint) > 0 {
            continues(along(things[i], joint[0]), along(things[-1], joint[0]))
        } else {
            touch_smoothly(things[i], things[-1])
        }
    }
}
constraint tangent(things: list, inside: bool) {
    for i in 0..<len(things) - 1 {
        let a = round_radius(things[i])
        let b = round_radius(things[-1])
        norm(things[-1].center - things[i].center) == (if inside then abs(a - b) else a + b)
    }
}

// Two directions are the same, or opposite.
constraint continues(a: point, b: point) { cross(a, b) / norm(a) / norm(b) == 0 }

// The direction of a curve at one of its ends.
fn along(l: line, at_end: point) = vector(l)
fn along(a: arc, at_end: point) = turned(at_end - a.center, 90deg)
fn along(b: bezier, at_end: point) = if norm(written(at_end - b.p0)) <= norm(
    written(at_end - b.p3)
) then b.p1 - b.p0 else b.p3 - b.p2

// The ends that two curves share as they were written; an empty list when they share none.
fn shared_end(a: list, b: list) =
    [p for p in a if len(b) > 0 and min([norm(written(p - q)) for q in b]) < 0.000001]

// Two curves that share no end touch somewhere.
constraint touch_smoothly(l: line, c: circle) { beside_line(l, c.center, c.radius) }
constraint touch_smoothly(l: line, a: arc) { beside_line(l, a.center, a.radius) }
constraint touch_smoothly(l: line, e: ellipse) {
    beside_line(l, e.center, hypot(e.rx * sin(l.angle - e.angle), e.ry * cos(l.angle - e.angle)))
}
constraint touch_smoothly(c: circle, l: line) { beside_line(l, c.center, c.radius) }
constraint touch_smoothly(a: arc, l: line) { beside_line(l, a.center, a.radius) }
constraint touch_smoothly(e: ellipse, l: line) { touch_smoothly(l, e) }
constraint touch_smoothly(a: circle, b: circle) { circles_touch(a, b) }
constraint touch_smoothly(a: circle, b: arc) { circles_touch(a, b) }
constraint touch_smoothly(a: arc, b: circle) { circles_touch(a, b) }
constraint touch_smoothly(a: arc, b: arc) { circles_touch(a, b) }
constraint touch_smoothly(p: point, other) {
    refuse("a point has no direction; `coincident` puts it on a curve")
}
constraint touch_smoothly(other, p: point) {
    refuse("a point has no direction; `coincident` puts it on a curve")
}
constraint touch_smoothly(a: line, b: line) {
    refuse("two lines touch where they share an end only; `parallel` and `collinear` say the rest")
}
constraint touch_smoothly(b: bezier, other) {
    refuse("a bezier is tangent at an end it shares, as in `bezier(l.end, …)`")
}
constraint touch_smoothly(other, b: bezier) {
    refuse("a bezier is tangent at an end it shares, as in `bezier(l.end, …)`")
}

// A line runs at a distance from a point, on the side where it is.
constraint beside_line(l: line, center: point, far: length) {
    offset_from(center, l) == nearest(offset_from(center, l), [far, -far])
}

// The centres of round things are as far apart as touching from outside or inside asks, which is nearer.
constraint circles_touch(a, b) {
    let now = norm(b.center - a.center)
    now == nearest(now, [a.radius + b.radius, a.radius - b.radius, b.radius - a.radius])
}

fn round_radius(c: circle) = c.radius
fn round_radius(a: arc) = a.radius

alias tangential = tangent
alias tangent_to = tangent
alias smooth = tangent
alias tangent_with = tangent
