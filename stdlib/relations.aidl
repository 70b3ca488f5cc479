// Relations between boxes: structures, geometry, and lists of them.

/// The box of anything that has one; of a list, the box around all of it.
fn box(of: box) = of

/// a lies above b: its bottom at or beyond the top of b. `gap` is exact, `at_least` a minimum.
constraint above(a: box, b: box) { a.bottom >= b.top }
constraint above(a: box, b: box, gap: length) { a.bottom == b.top + gap }
constraint above(a: box, b: box, at_least: length) { a.bottom >= b.top + at_least }

/// a lies below b.
constraint below(a: box, b: box) { a.top <= b.bottom }
constraint below(a: box, b: box, gap: length) { a.top == b.bottom - gap }
constraint below(a: box, b: box, at_least: length) { a.top <= b.bottom - at_least }

/// a lies to the left of b.
constraint left_of(a: box, b: box) { a.right <= b.left }
constraint left_of(a: box, b: box, gap: length) { a.right == b.left - gap }
constraint left_of(a: box, b: box, at_least: length) { a.right <= b.left - at_least }

/// a lies to the right of b.
constraint right_of(a: box, b: box) { a.left >= b.right }
constraint right_of(a: box, b: box, gap: length) { a.left == b.right + gap }
constraint right_of(a: box, b: box, at_least: length) { a.left >= b.right + at_least }

/// a stands on b: touching, and over it sideways.
constraint on_top_of(a: box, b: box) {
    a.bottom == b.top
    a.center_x >= b.left
    a.center_x <= b.right
}
constraint on_top_of(a: box, b: box, align: text) {
    let side = choice(align, ["left", "center", "right"])
    a.bottom == b.top
    if side == "left" {
        a.left == b.left
    } else if side == "right" {
        a.right == b.right
    } else {
        a.center_x == b.center_x
    }
}

/// a stands on b, both centred.
constraint stacked_on(a: box, b: box) {
    a.bottom == b.top
    a.center_x == b.center_x
}

/// The box of a lies within the box of b, `margin` or more from its border.
constraint inside(a: box, b: box, margin: length = 0) {
    a.left >= b.left + margin
    a.right <= b.right - margin
    a.bottom >= b.bottom + margin
    a.top <= b.top - margin
}
constraint contains(b: box, a: box, margin: length = 0) { inside(a, b, margin: margin) }

/// The centres of a and b agree.
constraint centered_in(a: box, b: box) {
    a.center_x == b.center_x
    a.center_y == b.center_y
}
constraint centered_horizontally(a: box, b: box) { a.center_x == b.center_x }
constraint centered_vertically(a: box, b: box) { a.center_y == b.center_y }

/// The left sides (right, top, … ) of all agree; the last one is held. `inset` moves the others inwards.
constraint align_left(things: list, inset: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).left == box(things[-1]).left + inset }
}
constraint align_right(things: list, inset: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).right == box(things[-1]).right - inset }
}
constraint align_top(things: list, inset: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).top == box(things[-1]).top - inset }
}
constraint align_bottom(things: list, inset: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).bottom == box(things[-1]).bottom + inset }
}
constraint align_center_x(things: list) {
    for i in 0..<len(things) - 1 { box(things[i]).center_x == box(things[-1]).center_x }
}
constraint align_center_y(things: list) {
    for i in 0..<len(things) - 1 { box(things[i]).center_y == box(things[-1]).center_y }
}

/// All have the width (height, or both) of the last.
constraint same_width(things: list) {
    for i in 0..<len(things) - 1 { box(things[i]).width == box(things[-1]).width }
}
constraint same_height(things: list) {
    for i in 0..<len(things) - 1 { box(things[i]).height == box(things[-1]).height }
}
constraint same_size(things: list) {
    for i in 0..<len(things) - 1 {
        box(things[i]).width == box(things[-1]).width
        box(things[i]).height == box(things[-1]).height
    }
}

/// a is at least as wide (tall, …) as b.
constraint wider(a: box, b: box) { a.width >= b.width }
constraint narrower(a: box, b: box) { a.width <= b.width }
constraint taller(a: box, b: box) { a.height >= b.height }
constraint shorter(a: box, b: box) { a.height <= b.height }

/// From left to right (top to bottom) with exact gaps; `align` also lines them up across.
constraint row(things: list, gap: length) {
    for i in 1..<len(things) { box(things[i]).left == box(things[i - 1]).right + gap }
}
constraint row(things: list, gap: length, align: text) {
    let side = choice(align, ["top", "center", "bottom"])
    for i in 1..<len(things) {
        box(things[i]).left == box(things[i - 1]).right + gap
        if side == "top" {
            box(things[i]).top == box(things[i - 1]).top
        } else if side == "bottom" {
            box(things[i]).bottom == box(things[i - 1]).bottom
        } else {
            box(things[i]).center_y == box(things[i - 1]).center_y
        }
    }
}
constraint column(things: list, gap: length) {
    for i in 1..<len(things) { box(things[i]).top == box(things[i - 1]).bottom - gap }
}
constraint column(things: list, gap: length, align: text) {
    let side = choice(align, ["left", "center", "right"])
    for i in 1..<len(things) {
        box(things[i]).top == box(things[i - 1]).bottom - gap
        if side == "left" {
            box(things[i]).left == box(things[i - 1]).left
        } else if side == "right" {
            box(things[i]).right == box(things[i - 1]).right
        } else {
            box(things[i]).center_x == box(things[i - 1]).center_x
        }
    }
}

/// Equal gaps in the order written; along the axis in which the first guesses spread most, unless it is said.
constraint evenly_spaced(things: list) { evenly_spaced(things, axis: longer_spread(things)) }
constraint evenly_spaced(things: list, axis: text) {
    let way = choice(axis, ["x", "y"])
    let up = len(things) < 2 or spread(things, way) >= 0
    for i in 2..<len(things) {
        let one = room_between(things[i - 2], things[i - 1], way, up)
        let next = room_between(things[i - 1], things[i], way, up)
        next == one
    }
}

/// How far it is from the first thing of a list to the last, as written, and along which axis it is further.
fn spread(things: list, axis: text) = written(along(things[-1], axis) - along(things[0], axis))
fn along(a: box, axis: text) = if axis == "x" then a.center_x else a.center_y
fn longer_spread(a: list) = if len(a) > 1 and abs(spread(a, "x")) < abs(
    spread(a, "y")
) then "y" else "x"

/// The gap from one thing to the next, which lies beyond it (`up`) or before it along the axis.
fn room_between(a: box, b: box, axis: text, up: bool) = if up then room(a, b, axis) else room(
    b,
    a,
    axis
)
fn room(a: box, b: box, axis: text) = if axis == "x" then b.left - a.right else b.bottom - a.top

/// The boxes share a border: the nearest pair of sides meets.
constraint touching(a: box, b: box) {
    let over = written(a.bottom - b.top)
    let under = written(b.bottom - a.top)
    let beyond = written(a.left - b.right)
    let before = written(b.left - a.right)
    let most = max(over, under, beyond, before)
    if over == most {
        a.bottom == b.top
    } else if under == most {
        a.top == b.bottom
    } else if beyond == most {
        a.left == b.right
    } else {
        a.right == b.left
    }
    if over == most or under == most {
        a.left <= b.right
        a.right >= b.left
    } else {
        a.bottom <= b.top
        a.top >= b.bottom
    }
}

/// The boxes are apart (share a part): along the direction in which the first guesses are furthest apart.
constraint no_overlap(a: box, b: box) {
    max(a.bottom - b.top, b.bottom - a.top, a.left - b.right, b.left - a.right) >= 0
}
constraint overlapping(a: box, b: box) {
    a.left <= b.right
    a.right >= b.left
    a.bottom <= b.top
    a.top >= b.bottom
}

alias over = above
alias on_top = on_top_of
alias under = below
alias beneath = below
alias underneath = below
alias to_the_left_of = left_of
alias to_left_of = left_of
alias to_the_right_of = right_of
alias to_right_of = right_of
alias within = inside
alias center_inside = centered_in
alias centered = centered_in
alias center_horizontally = centered_horizontally
alias center_vertically = centered_vertically
alias equal_width = same_width
alias equal_height = same_height
alias equal_size = same_size
alias stacked = stacked_on
alias not_overlapping = no_overlap
