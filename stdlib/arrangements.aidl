// Relations of several boxes: lined up, of one size, in rows and columns, evenly spaced.

/// The left sides of all agree; the last one named is held. `inset` moves the others inwards, `by` to the right.
///
/// ```aidl
/// drawing d {
///     page  = rectangle(center: fixed((0, 0)), width: 60, height: 80)
///     title = rectangle(center: (5, 25), width: 40, height: 8)
///     body  = rectangle(center: (3, -5), width: 50, height: 40)
///     constrain align_left(title, body, page, inset: 4)
/// }
/// ```
constraint align_left(things: list, inset: length = 0, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).left == box(things[-1]).left + inset + by }
}

/// The right sides of all agree; the last one named is held. `inset` moves the others inwards, `by` to the right.
///
/// ```aidl
/// drawing d {
///     page = rectangle(center: fixed((0, 0)), width: 60, height: 80)
///     date = rectangle(center: (5, 25), width: 20, height: 6)
///     constrain align_right(date, page, inset: 4)
/// }
/// ```
constraint align_right(things: list, inset: length = 0, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).right == box(things[-1]).right - inset + by }
}

/// The tops of all agree; the last one named is held. `inset` moves the others inwards, `by` upwards.
///
/// ```aidl
/// drawing d {
///     page = rectangle(center: fixed((0, 0)), width: 60, height: 80)
///     logo = circle(center: (-15, 25), radius: 6)
///     constrain align_top(logo, page, inset: 4)
/// }
/// ```
constraint align_top(things: list, inset: length = 0, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).top == box(things[-1]).top - inset + by }
}

/// The bottoms of all agree; the last one named is held. `inset` moves the others inwards, `by` upwards.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: fixed((0, 0)), width: 12, height: 30)
///     b = rectangle(center: (20, 4), width: 12, height: 20)
///     c = rectangle(center: (40, 9), width: 12, height: 40)
///     constrain align_bottom(b, c, a)
/// }
/// ```
constraint align_bottom(things: list, inset: length = 0, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).bottom == box(things[-1]).bottom + inset + by }
}

/// The centres of all agree from left to right; the last one is held. `by` moves the others to the right.
///
/// ```aidl
/// drawing d {
///     a = circle(center: fixed((0, 0)), radius: 12)
///     b = circle(center: (4, 24), radius: 8)
///     c = circle(center: (-4, 40), radius: 5)
///     constrain align_center_x(c, b, a)
/// }
/// ```
constraint align_center_x(things: list, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).center_x == box(things[-1]).center_x + by }
}

/// The centres of all agree from bottom to top; the last one is held. `by` moves the others upwards.
///
/// ```aidl
/// drawing d {
///     a = circle(center: fixed((0, 0)), radius: 12)
///     b = circle(center: (24, 4), radius: 8)
///     c = circle(center: (40, -4), radius: 5)
///     constrain align_center_y(c, b, a)
/// }
/// ```
constraint align_center_y(things: list, by: length = 0) {
    for i in 0..<len(things) - 1 { box(things[i]).center_y == box(things[-1]).center_y + by }
}

/// One side (`left`, `right`, `top`, `bottom`) of all agrees; the last one is held.
///
/// ```aidl
/// drawing d {
///     wall  = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     shelf = rectangle(center: (10, 5), width: 20, height: 4)
///     constrain flush(shelf, wall, side: right)
/// }
/// ```
constraint flush(things: list, side: text, by: length = 0) {
    let edge = choice(side, ["left", "right", "top", "bottom"])
    if edge == "left" { align_left(things, by: by) }
    if edge == "right" { align_right(things, by: by) }
    if edge == "top" { align_top(things, by: by) }
    if edge == "bottom" { align_bottom(things, by: by) }
}

/// From left to right, each beyond the one before; `gap` is exact, `at_least` a minimum.
///
/// `pitch` is the way from centre to centre. `align` (top, center, bottom) also lines them up.
/// The members of a list count one by one, also beside other things; `[battlements]` is one group.
///
/// ```aidl
/// drawing d {
///     for i in 0..3 { book[i] = rectangle(center: (14 * i, i), width: 8 + 2 * i, height: 30 + 3 * i) }
///     constrain row(book, gap: 2, align: bottom)
/// }
/// ```
constraint row(things: peers, gap: length, align: text = "free") {
    for i in 1..<len(things) {
        right_of(box(things[i]), box(things[i - 1]), gap: gap, align: align)
    }
}
constraint row(things: peers, at_least: length = 0, align: text = "free") {
    for i in 1..<len(things) {
        right_of(box(things[i]), box(things[i - 1]), at_least: at_least, align: align)
    }
}
constraint row(things: peers, pitch: length, align: text = "free") {
    for i in 1..<len(things) {
        box(things[i]).center_x == box(things[i - 1]).center_x + pitch
        level_up(box(things[i]), box(things[i - 1]), align)
    }
}

/// From top to bottom, each below the one before; `gap` is exact, `at_least` a minimum.
///
/// `pitch` is the way from centre to centre. `align` (left, center, right) also lines them up.
/// The members of a list count one by one, also beside other things; `[battlements]` is one group.
///
/// ```aidl
/// drawing d {
///     for i in 0..3 { line_of_text[i] = rectangle(center: (i, -10 * i), width: 60 - 8 * i, height: 5) }
///     constrain column(line_of_text, gap: 3, align: left)
/// }
/// ```
constraint column(things: peers, gap: length, align: text = "free") {
    for i in 1..<len(things) { below(box(things[i]), box(things[i - 1]), gap: gap, align: align) }
}
constraint column(things: peers, at_least: length = 0, align: text = "free") {
    for i in 1..<len(things) {
        below(box(things[i]), box(things[i - 1]), at_least: at_least, align: align)
    }
}
constraint column(things: peers, pitch: length, align: text = "free") {
    for i in 1..<len(things) {
        box(things[i]).center_y == box(things[i - 1]).center_y - pitch
        lined_up(box(things[i]), box(things[i - 1]), align)
    }
}

/// Equal gaps in the order written, along `axis`, or else where the first guesses spread most.
///
/// Along x the order is from left to right; along y upwards, or downwards if the first guesses run so. `gap` (or
/// `spacing`) says how wide the gaps are, `pitch` the way from centre to centre; else nothing overlaps.
///
/// ```aidl
/// drawing d {
///     for i in 0..4 { peg[i] = circle(center: (20 * i + 2 * i * i, 0), radius: 2 + i) }
///     constrain {
///         evenly_spaced(peg)
///         peg[0].center == (0, 0)
///         peg[4].center == (100, 0)
///     }
/// }
/// ```
constraint evenly_spaced(things: peers) { evenly_spaced(things, axis: longer_way(things)) }
constraint evenly_spaced(things: peers, axis: text) {
    let line = in_order(things, choice(axis, ["x", "y"]))
    for i in 2..<len(line) {
        room(line[i - 1], line[i], axis) == room(line[i - 2], line[i - 1], axis)
    }
    if len(line) > 1 { room(line[0], line[1], axis) >= 0 }
}
constraint evenly_spaced(things: peers, gap: length) {
    evenly_spaced(things, gap: gap, axis: longer_way(things))
}
constraint evenly_spaced(things: peers, gap: length, axis: text) {
    let line = in_order(things, choice(axis, ["x", "y"]))
    for i in 1..<len(line) { room(line[i - 1], line[i], axis) == gap }
}
constraint evenly_spaced(things: peers, spacing: length) { evenly_spaced(things, gap: spacing) }
constraint evenly_spaced(things: peers, spacing: length, axis: text) {
    evenly_spaced(things, gap: spacing, axis: axis)
}
constraint evenly_spaced(things: peers, pitch: length) {
    evenly_spaced(things, pitch: pitch, axis: longer_way(things))
}
constraint evenly_spaced(things: peers, pitch: length, axis: text) {
    let line = in_order(things, choice(axis, ["x", "y"]))
    for i in 1..<len(line) {
        place_along(line[i], axis) == place_along(line[i - 1], axis) + pitch
    }
}

// How far it is from the first thing of a list to the last, as written, and along which axis it is further.
fn way_along(things: list, axis: text) = if len(things) < 2 then 0mm else written(
    place_along(things[-1], axis) - place_along(things[0], axis)
)
fn place_along(a: box, axis: text) = if axis == "x" then a.center_x else a.center_y
fn longer_way(a: list) = if abs(way_along(a, "x")) < abs(way_along(a, "y")) then "y" else "x"

// The things as they follow along an axis: in their order, unless they were written downwards.
fn in_order(things: list, axis: text) =
    if axis == "y" and way_along(things, axis) < 0 then reversed(things) else things

// The gap from one thing to the next along an axis.
fn room(a: box, b: box, axis: text) = if axis == "x" then b.left - a.right else b.bottom - a.top

alias same_left = align_left
alias same_lefts = align_left
alias equal_left = align_left
alias same_left_side = align_left
alias same_left_edge = align_left
alias left_align = align_left
alias aligned_left = align_left
alias align_left_edges = align_left
alias align_left_sides = align_left
alias flush_left = align_left
alias same_right = align_right
alias same_rights = align_right
alias equal_right = align_right
alias same_right_side = align_right
alias same_right_edge = align_right
alias right_align = align_right
alias aligned_right = align_right
alias align_right_edges = align_right
alias align_right_sides = align_right
alias flush_right = align_right
alias same_top = align_top
alias same_tops = align_top
alias equal_top = align_top
alias same_top_edge = align_top
alias top_align = align_top
alias aligned_top = align_top
alias align_top_edges = align_top
alias flush_top = align_top
alias same_bottom = align_bottom
alias same_bottoms = align_bottom
alias equal_bottom = align_bottom
alias same_bottom_edge = align_bottom
alias bottom_align = align_bottom
alias aligned_bottom = align_bottom
alias align_bottom_edges = align_bottom
alias flush_bottom = align_bottom
alias same_center_x = align_center_x
alias same_centre_x = align_center_x
alias equal_center_x = align_center_x
alias same_x = align_center_x
alias same_center_y = align_center_y
alias same_centre_y = align_center_y
alias equal_center_y = align_center_y
alias same_y = align_center_y
alias left_aligned = align_left
alias align_lefts = align_left
alias right_aligned = align_right
alias align_rights = align_right
alias top_aligned = align_top
alias align_tops = align_top
alias bottom_aligned = align_bottom
alias align_bottoms = align_bottom
alias align_centers_x = align_center_x
alias align_centre_x = align_center_x
alias align_horizontal_centers = align_center_x
alias align_centers_y = align_center_y
alias align_centre_y = align_center_y
alias align_vertical_centers = align_center_y
alias align = flush
alias flush_with = flush
alias in_a_row = row
alias in_row = row
alias side_by_side = row
alias left_to_right = row
alias in_a_column = column
alias in_column = column
alias stack = column
alias top_to_bottom = column
alias evenly_distributed = evenly_spaced
alias distribute = evenly_spaced
alias distribute_evenly = evenly_spaced
alias equal_spacing = evenly_spaced
alias equally_spaced = evenly_spaced
alias equidistant = evenly_spaced
alias even_spacing = evenly_spaced
alias equal_gaps = evenly_spaced
