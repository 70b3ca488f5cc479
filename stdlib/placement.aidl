// Places for things that exist, and points and axes to place them by.

/// The centres of things lie on a circle: one that is there, or about `center` with a `radius` or `diameter`.
///
/// They stand at equal steps in their written order, the first at `start` if that is said; `evenly: false`
/// leaves them (with `start` all but the first) where they are along the circle.
///
/// ```aidl
/// solid flange {
///     rim = circle(center: origin, radius: 40)
///     for i in 0..5 {
///         hole bolt[i] { bore = circle(center: polar(30, 60deg * i), radius: 3) }
///     }
///     constrain on_circle(bolt, center: rim.center, diameter: 60, start: 30deg)
/// }
/// ```
constraint on_circle(things: peers, center: point, radius: length, evenly: bool = true) {
    for i in 0..<len(things) {
        let way = box(things[i]).center - center
        if evenly and i > 0 {
            way == turned(box(things[i - 1]).center - center, turn_around(things, center))
        } else {
            norm(way) == radius
        }
    }
}
constraint on_circle(things: peers, center: point, diameter: length, evenly: bool = true) {
    on_circle(things, center: center, radius: diameter / 2, evenly: evenly)
}
constraint on_circle(
    things: peers, center: point, radius: length, start: angle, evenly: bool = true
) {
    let turn = turn_around(things, center)
    for i in 0..<len(things) {
        if evenly or i == 0 {
            box(things[i]).center == center + polar(radius, start + turn * i)
        } else {
            norm(box(things[i]).center - center) == radius
        }
    }
}
constraint on_circle(
    things: peers, center: point, diameter: length, start: angle, evenly: bool = true
) {
    on_circle(things, center: center, radius: diameter / 2, start: start, evenly: evenly)
}
constraint on_circle(things: peers, around: circle, evenly: bool = true) {
    on_circle(things, center: around.center, radius: around.radius, evenly: evenly)
}
constraint on_circle(things: peers, around: circle, start: angle, evenly: bool = true) {
    on_circle(things, center: around.center, radius: around.radius, start: start, evenly: evenly)
}

// The angle from one thing to the next: the sense in which most of the first guesses run.
fn turn_around(things: list, center: point) = if len(things) < 2 then 0deg else (if sum(
    [written(
        cross(box(things[i - 1]).center - center, box(things[i]).center - center)
    ) / 1mm / 1mm for i in 1..<len(things)]
) < 0 then -360deg else 360deg) / len(things)

/// Four things stand at the corners of a box, their centres `inset` from both sides, or `(dx, dy)`.
///
/// Each goes to the corner in whose quarter it was written; where that gives no four corners, they go
/// counter-clockwise from the bottom left.
///
/// ```aidl
/// solid plate {
///     body = rectangle(center: origin, width: 80, height: 50)
///     for i in 0..3 { hole screw[i] { bore = circle(center: polar(20, 90deg * i + 225deg), radius: 3) } }
///     constrain at_corners(screw, body, inset: 8)
/// }
/// ```
constraint at_corners(things: peers, of: box, inset: length = 0) {
    at_corners(things, of, inset: (inset, inset))
}
constraint at_corners(things: peers, of: box, inset: point) {
    if len(things) == 4 {
        let spots = [
            of.bottom_left + inset,
            of.bottom_right + (-inset.x, inset.y),
            of.top_right - inset,
            of.top_left + (inset.x, -inset.y)
        ]
        let quarters = [quarter(box(t), of) for t in things]
        let distinct = sum([1 for i in 0..3 if i in quarters] + [0]) == 4
        for i in 0..3 { box(things[i]).center == spots[if distinct then quarters[i] else i] }
    } else {
        refuse("a box has four corners, so four things can stand there")
    }
}

// The corner of a box in whose quarter a thing was written, counter-clockwise from 0 at the bottom left.
fn quarter(a: box, of: box) = if written(a.center_y - of.center_y) < 0 then if written(
    a.center_x - of.center_x
) < 0 then 0 else 1 else if written(a.center_x - of.center_x) < 0 then 3 else 2

/// Things are spread through a box with equal gaps in their order, along `axis` or where it is longer for them.
///
/// Without `margin` the room before the first and behind the last is as wide as a gap; with it, they stand that
/// far from the border (`margin: 0`: flush). Nothing overlaps, and nothing stands out. Along x the order is
/// from left to right; along y upwards, or downwards if the first guesses run so. One thing is centred.
/// The members of a list count one by one, also beside other things; `[slits]` is one group.
///
/// ```aidl
/// solid panel {
///     body = rectangle(center: origin, width: 120, height: 40)
///     for i in 0..4 { hole slit[i] { cut = slot(start: (9 * i, -8), end: (9 * i, 8), width: 6) } }
///     constrain {
///         spread(slit, inside: body)
///         align_center_y(slit, body)
///     }
/// }
/// ```
constraint spread(things: peers, inside: box) {
    spread(things, inside: inside, axis: longer_way(things))
}
constraint spread(things: peers, inside: box, margin: length) {
    spread(things, inside: inside, axis: longer_way(things), margin: margin)
}
constraint spread(things: peers, inside: box, axis: text) {
    let line = in_order(things, choice(axis, ["x", "y"]))
    if len(line) == 1 {
        place_along(line[0], axis) == place_along(inside, axis)
    } else if len(line) > 1 {
        evenly_spaced(things, axis: axis)
        room_before(line[0], inside, axis) == room(line[0], line[1], axis)
        room_behind(line[-1], inside, axis) == room(line[-2], line[-1], axis)
    }
}
constraint spread(things: peers, inside: box, axis: text, margin: length) {
    let line = in_order(things, choice(axis, ["x", "y"]))
    if len(line) == 1 {
        place_along(line[0], axis) == place_along(inside, axis)
    } else if len(line) > 1 {
        room_before(line[0], inside, axis) == margin
        room_behind(line[-1], inside, axis) == margin
        evenly_spaced(things, axis: axis)
    }
}
fn room_before(a: box, inside: box, axis: text) =
    if axis == "x" then a.left - inside.left else a.bottom - inside.bottom
fn room_behind(a: box, inside: box, axis: text) =
    if axis == "x" then inside.right - a.right else inside.top - a.top

/// The point between two things, points or centres: half the way from a to b, or a share of it.
///
/// ```aidl
/// drawing d {
///     a = circle(center: fixed((0, 0)), radius: 5)
///     b = circle(center: fixed((60, 20)), radius: 5)
///     lamp = circle(center: between(a, b), radius: 3)
///     nail = circle(center: between(a, b, 0.25), radius: 1)
/// }
/// ```
fn between(a, b) = (center_of(a) + center_of(b)) / 2
fn between(a, b, share: number) = center_of(a) + (center_of(b) - center_of(a)) * share

/// A point of a box by its name: `"top_left"`, `"left"` (the middle of that side), …; else its centre.
///
/// ```aidl
/// drawing d {
///     card = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     pin  = circle(center: (20, 30), radius: 2)
///     constrain coincident(pin.center, anchor(card, "top_left") + (5, -5))
/// }
/// ```
fn anchor(of: box, place: text = "center") = (share_of(
    of.left, of.right, side_of(place, "left", "right")
), share_of(of.bottom, of.top, side_of(place, "bottom", "top")))
fn share_of(low: length, high: length, share: number) = low + (high - low) * share
fn side_of(place: text, low: text, high: text) = if anchor_word(place) in words_of(
    low
) then 0 else if anchor_word(place) in words_of(high) then 1 else 0.5
fn anchor_word(place: text) = choice(
    place,
    [
        "center",
        "left",
        "right",
        "top",
        "bottom",
        "top_left",
        "top_right",
        "bottom_left",
        "bottom_right",
        "top_center",
        "bottom_center",
        "left_center",
        "right_center"
    ]
)
fn words_of(side: text) =
    [side, side + "_center", side + "_left", side + "_right", "top_" + side, "bottom_" + side]

/// The point at a share of the width and height of a box: (0, 0) is its lower left corner, (1, 1) its upper right one.
///
/// So what stands in a thing moves with its size, without a product for every point.
///
/// ```aidl
/// solid face {
///     param width = 40 in 30..60
///     head = ellipse(center: origin, rx: width / 2, ry: 25)
///     hole left_eye { v = circle(radius: 3) }
///     hole right_eye { v = circle(radius: 3) }
///     constrain {
///         left_eye.center == head.spot(0.3, 0.65)
///         right_eye.center == head.spot(0.7, 0.65)
///     }
/// }
/// ```
fn spot(of: box, x: number, y: number) = of.bottom_left + (of.width * x, of.height * y)

/// The points at shares of the width and height of a box, each written as `(x, y)` from (0, 0) to (1, 1).
///
/// A figure of free points then fills whatever box it is given.
///
/// ```aidl
/// solid bolt_of_lightning {
///     construction room = rectangle(width: 30, height: 60)
///     body = polygon(spots(room, [(0.3, 1), (0.8, 1), (0.6, 0.6), (1, 0.6), (0.2, 0), (0.4, 0.45), (0, 0.45)]))
/// }
/// ```
fn spots(of: box, points: list) = [spot(of, p.x / 1mm, p.y / 1mm) for p in points]

/// The point of an outline that has an `x` or a `y`, or lies a length `along` it from its start.
///
/// Of several with that `x` it is the uppermost, with that `y` the rightmost; `side: bottom` or `side: left` takes
/// the last on the other side.
///
/// ```aidl
/// solid hull {
///     shell = path(
///         (-60, 20), line_to(60, 20), smooth_to((40, -12), leaving: -100deg), line_to(-45, -12), close()
///     )
///     @color("white") port = circle(center: shell.edge_point(x: 20, side: bottom).up(10), radius: 4)
///     @color("firebrick") lamp = circle(center: shell.edge_point(y: 5), radius: 3)
///     @color("gold") buoy = circle(center: shell.edge_point(along: 30), radius: 3)
/// }
/// ```
fn edge_point(of, x: length, side: text = "top") = point_at(of, x, "x", choice(side, ["bottom", "top"]) == "top")
fn edge_point(of, y: length, side: text = "right") = point_at(of, y, "y", choice(side, ["left", "right"]) == "right")
fn edge_point(of, along: length) = point_at(of, along)

/// The endless upright line through a point, to be symmetric about or to lie on.
///
/// ```aidl
/// drawing d {
///     post = rectangle(center: fixed((10, 0)), width: 6, height: 50)
///     a = circle(center: (-12, 5), radius: guess(3))
///     b = circle(center: (30, 9), radius: 6)
///     constrain symmetric(a, b, about: vertical_through(post.center))
/// }
/// ```
fn vertical_through(p) = upright_through(center_of(p))

/// The endless level line through a point, to be symmetric about or to lie on.
///
/// ```aidl
/// drawing d {
///     bar = rectangle(center: fixed((0, 10)), width: 50, height: 6)
///     a = circle(center: (5, -12), radius: guess(3))
///     b = circle(center: (9, 30), radius: 6)
///     constrain symmetric(a, b, about: horizontal_through(bar.center))
/// }
/// ```
fn horizontal_through(p) = level_through(center_of(p))

/// The endless line through a point in a direction, to be symmetric about or to lie on.
///
/// ```aidl
/// drawing d {
///     hub = circle(center: fixed((0, 0)), radius: 6)
///     pin = circle(center: (20, 12), radius: 3)
///     constrain coincident(pin.center, line_through(hub.center, 45deg))
/// }
/// ```
fn line_through(p, angle: angle) =
    line(fixed(center_of(p)), fixed(center_of(p) + (cos(angle) * 1mm, sin(angle) * 1mm)))

alias vertical_axis = vertical_through
alias horizontal_axis = horizontal_through
alias on_bolt_circle = on_circle
alias bolt_circle_of = on_circle
alias around_circle = on_circle
alias in_corners = at_corners
alias to_corners = at_corners
alias distribute_in = spread
alias spread_out = spread
alias spread_inside = spread
alias point_between = between
alias anchor_point = anchor
alias place_in = spot
alias point_in = spot
alias at_share = spot
alias places_in = spots
