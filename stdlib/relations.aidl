// Relations between two boxes: structures, geometry, and lists of them (a list is one group).

// The box of anything that has one; of a list, the box around all of it.
fn box(of: box) = of

// --- Beyond a side ---------------------------------------------------------------------------------

/// a lies above b: its bottom at or beyond the top of b.
///
/// `gap` is exact, `at_least` a minimum; `align` (left, center, right) also lines them up across.
///
/// ```aidl
/// drawing d {
///     base = rectangle(center: fixed((0, 0)), width: 60, height: 16)
///     lid  = rectangle(center: (5, 30), width: 50, height: 10)
///     constrain above(lid, base, gap: 4, align: center)
/// }
/// ```
constraint above(a: box, b: box, gap: length, align: text = "free") {
    a.bottom == b.top + gap
    lined_up(a, b, align)
}
constraint above(a: box, b: box, at_least: length = 0, align: text = "free") {
    a.bottom >= b.top + at_least
    lined_up(a, b, align)
}

/// a lies below b: its top at or beyond the bottom of b.
///
/// `gap` is exact, `at_least` a minimum; `align` (left, center, right) also lines them up across.
///
/// ```aidl
/// drawing d {
///     roof = rectangle(center: fixed((0, 0)), width: 60, height: 16)
///     door = rectangle(center: (5, -30), width: 14, height: 24)
///     constrain below(door, roof, gap: 0, align: left)
/// }
/// ```
constraint below(a: box, b: box, gap: length, align: text = "free") {
    a.top == b.bottom - gap
    lined_up(a, b, align)
}
constraint below(a: box, b: box, at_least: length = 0, align: text = "free") {
    a.top <= b.bottom - at_least
    lined_up(a, b, align)
}

/// a lies to the left of b: its right side at or beyond the left side of b.
///
/// `gap` is exact, `at_least` a minimum; `align` (top, center, bottom) also lines them up.
///
/// ```aidl
/// drawing d {
///     house  = rectangle(center: fixed((0, 0)), width: 40, height: 50)
///     garage = rectangle(center: (-40, 5), width: 30, height: 20)
///     constrain left_of(garage, house, gap: 2, align: bottom)
/// }
/// ```
constraint left_of(a: box, b: box, gap: length, align: text = "free") {
    a.right == b.left - gap
    level_up(a, b, align)
}
constraint left_of(a: box, b: box, at_least: length = 0, align: text = "free") {
    a.right <= b.left - at_least
    level_up(a, b, align)
}

/// a lies to the right of b: its left side at or beyond the right side of b.
///
/// `gap` is exact, `at_least` a minimum; `align` (top, center, bottom) also lines them up.
///
/// ```aidl
/// drawing d {
///     house = rectangle(center: fixed((0, 0)), width: 40, height: 50)
///     shed  = rectangle(center: (40, 5), width: 20, height: 16)
///     constrain right_of(shed, house, at_least: 6, align: bottom)
/// }
/// ```
constraint right_of(a: box, b: box, gap: length, align: text = "free") {
    a.left == b.right + gap
    level_up(a, b, align)
}
constraint right_of(a: box, b: box, at_least: length = 0, align: text = "free") {
    a.left >= b.right + at_least
    level_up(a, b, align)
}

/// a lies to the left or to the right of b, on the side where it is.
///
/// `gap` is exact, `at_least` a minimum; `align` (top, center, bottom) also lines them up.
///
/// ```aidl
/// drawing d {
///     dial = circle(center: fixed((0, 0)), radius: 20)
///     a = circle(center: (-40, 5), radius: 6)
///     b = circle(center: (35, 5), radius: 6)
///     constrain {
///         beside(a, dial, gap: 3, align: center)
///         beside(b, dial, gap: 3, align: center)
///     }
/// }
/// ```
constraint beside(a: box, b: box, gap: length, align: text = "free") {
    if written(a.center_x - b.center_x) < 0 {
        left_of(a, b, gap: gap, align: align)
    } else {
        right_of(a, b, gap: gap, align: align)
    }
}
constraint beside(a: box, b: box, at_least: length = 0, align: text = "free") {
    if written(a.center_x - b.center_x) < 0 {
        left_of(a, b, at_least: at_least, align: align)
    } else {
        right_of(a, b, at_least: at_least, align: align)
    }
}

/// a stands on b: its bottom on the top of b, and not beside it.
///
/// Sideways a may stand anywhere over b, as long as they overlap by a tenth of the narrower one;
/// `align` (left, center, right) lines them up. Nothing is centred by itself: that is `stacked_on`.
///
/// ```aidl
/// drawing d {
///     table  = rectangle(center: fixed((0, 0)), width: 80, height: 8)
///     bottle = rectangle(center: (32, 30), width: 12, height: 30)
///     book   = rectangle(center: (-20, 30), width: 30, height: 6)
///     constrain {
///         on_top_of(bottle, table)
///         on_top_of(book, table, align: left)
///     }
/// }
/// ```
constraint on_top_of(a: box, b: box) {
    a.bottom == b.top
    share_width(a, b)
}
constraint on_top_of(a: box, b: box, align: text) { above(a, b, gap: 0, align: align) }

// Two boxes have a stretch in common, seen from above and from the side: a tenth of the smaller one or more.
constraint share_width(a: box, b: box) {
    let least = min(a.width, b.width) / 10
    a.left + least <= b.right
    a.right - least >= b.left
}
constraint share_height(a: box, b: box) {
    let least = min(a.height, b.height) / 10
    a.bottom + least <= b.top
    a.top - least >= b.bottom
}

/// a stands on b, both centred.
///
/// ```aidl
/// drawing d {
///     foot = rectangle(center: fixed((0, 0)), width: 60, height: 10)
///     bowl = circle(center: (20, 40), radius: 20)
///     constrain stacked_on(bowl, foot)
/// }
/// ```
constraint stacked_on(a: box, b: box) { above(a, b, gap: 0, align: "center") }

// Lined up across, for things one above the other and side by side.
constraint lined_up(a: box, b: box, align: text) {
    let side = choice(align, ["free", "left", "center", "right"])
    if side == "left" { a.left == b.left }
    if side == "center" { a.center_x == b.center_x }
    if side == "right" { a.right == b.right }
}
constraint level_up(a: box, b: box, align: text) {
    let side = choice(align, ["free", "top", "center", "bottom"])
    if side == "top" { a.top == b.top }
    if side == "center" { a.center_y == b.center_y }
    if side == "bottom" { a.bottom == b.bottom }
}

// --- Within ----------------------------------------------------------------------------------------

/// The box of a lies within the box of b, `margin` or more from its border; `(dx, dy)` for both ways.
///
/// ```aidl
/// drawing d {
///     panel = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     knob  = circle(center: (40, 30), radius: 6)
///     constrain inside(knob, panel, margin: 3)
/// }
/// ```
constraint inside(a: box, b: box, margin: length = 0) { inside(a, b, margin: (margin, margin)) }
constraint inside(a: box, p: point) {
    refuse("nothing lies inside a point; `coincident` and `centered_in` put it there")
}
constraint inside(a: box, b: box, margin: point) {
    a.left >= b.left + margin.x
    a.right <= b.right - margin.x
    a.bottom >= b.bottom + margin.y
    a.top <= b.top - margin.y
}

/// The box of b holds the box of a: `inside` the other way round, and b is held.
///
/// ```aidl
/// drawing d {
///     panel = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     knob  = circle(center: (40, 30), radius: 6)
///     constrain contains(panel, knob, margin: 3)
/// }
/// ```
constraint contains(p: point, a: box) { inside(a, p) }
constraint contains(b: box, a: box, margin: length = 0) { inside(a, b, margin: margin) }
constraint contains(b: box, a: box, margin: point) { inside(a, b, margin: margin) }

/// The centres of a and b agree; `by` moves a away from there.
///
/// ```aidl
/// drawing d {
///     panel = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     dial  = circle(center: (20, 9), radius: 14)
///     lamp  = circle(center: (1, 1), radius: 2)
///     constrain {
///         centered_in(dial, panel)
///         centered_in(lamp, panel, by: (20, 10))
///     }
/// }
/// ```
constraint centered_in(a: box, b: box, by: point = (0, 0)) {
    a.center_x == b.center_x + by.x
    a.center_y == b.center_y + by.y
}

/// The centres agree from left to right; `by` moves a to the right of there.
///
/// ```aidl
/// drawing d {
///     panel = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     lamp  = circle(center: (9, 12), radius: 4)
///     constrain centered_horizontally(lamp, panel)
/// }
/// ```
constraint centered_horizontally(a: box, b: box, by: length = 0) { a.center_x == b.center_x + by }

/// The centres agree from bottom to top; `by` moves a above there.
///
/// ```aidl
/// drawing d {
///     panel = rectangle(center: fixed((0, 0)), width: 60, height: 40)
///     lamp  = circle(center: (20, 3), radius: 4)
///     constrain centered_vertically(lamp, panel)
/// }
/// ```
constraint centered_vertically(a: box, b: box, by: length = 0) { a.center_y == b.center_y + by }

/// a stands between b and c with the same room on both sides, along the axis on which they are further apart.
/// Either of b and c may be the one on the left, or below; where a is wider than the room, it reaches as far over both.
///
/// ```aidl
/// drawing d {
///     left_wall  = rectangle(center: fixed((-40, 0)), width: 10, height: 40)
///     right_wall = rectangle(center: fixed((30, 0)), width: 20, height: 40)
///     ball = circle(center: (0, -10), radius: 8)
///     constrain centered_between(ball, left_wall, right_wall)
/// }
/// ```
constraint centered_between(a: box, b: box, c: box) { amid(a, from: b, to: c) }
constraint centered_between(a: box, b: box, c: box, axis: text) {
    amid(a, from: b, to: c, axis: axis)
}
constraint amid(a: box, from: box, to: box) {
    amid(a, from: from, to: to, axis: longer_way([from, to]))
}
constraint amid(a: box, from: box, to: box, axis: text) {
    if choice(axis, ["x", "y"]) == "x" {
        a.left + a.right == min(from.right, to.right) + max(from.left, to.left)
    } else {
        a.bottom + a.top == min(from.top, to.top) + max(from.bottom, to.bottom)
    }
}

// --- Contact ---------------------------------------------------------------------------------------

/// The boxes share a border, not only a corner: the nearest pair of sides meets.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: fixed((0, 0)), width: 40, height: 20)
///     b = rectangle(center: (34, 8), width: 20, height: 20)
///     constrain touching(b, a)
/// }
/// ```
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
        share_width(a, b)
    } else {
        share_height(a, b)
    }
}

/// The boxes are apart, `at_least` so much, in whatever direction; of several things, each from each.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: fixed((0, 0)), width: 30, height: 20)
///     b = rectangle(center: (20, 4), width: 20, height: 20)
///     c = rectangle(center: (4, 16), width: 20, height: 16)
///     constrain no_overlap(c, b, a)
/// }
/// ```
constraint no_overlap(a: box, b: box, at_least: length = 0) {
    max(a.bottom - b.top, b.bottom - a.top, a.left - b.right, b.left - a.right) >= at_least
}
constraint no_overlap(things: list, at_least: length = 0) {
    for i in 1..<len(things) {
        for j in 0..<i { no_overlap(box(things[j]), box(things[i]), at_least: at_least) }
    }
}

/// The boxes have an area in common, not only a border: a tenth of the smaller one or more, both ways.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: fixed((0, 0)), width: 30, height: 20)
///     b = rectangle(center: (50, 14), width: 20, height: 20)
///     constrain overlapping(b, a)
/// }
/// ```
constraint overlapping(a: box, b: box) {
    share_width(a, b)
    share_height(a, b)
}

alias over = above
alias higher_than = above
alias under = below
alias beneath = below
alias underneath = below
alias lower_than = below
alias to_the_left_of = left_of
alias to_left_of = left_of
alias left_from = left_of
alias to_the_right_of = right_of
alias to_right_of = right_of
alias right_from = right_of
alias next_to = beside
alias alongside = beside
alias on_top = on_top_of
alias atop = on_top_of
alias sits_on = on_top_of
alias stands_on = on_top_of
alias rests_on = on_top_of
alias stacked = stacked_on
alias stack_on = stacked_on
alias within = inside
alias inside_of = inside
alias fits_in = inside
alias contained_in = inside
alias encloses = contains
alias surrounds = contains
alias center_inside = centered_in
alias centre_inside = centered_in
alias centred_in = centered_in
alias centered = centered_in
alias centred = centered_in
alias center_in = centered_in
alias centered_on = centered_in
alias centered_at = centered_in
alias same_centers = centered_in
alias center_horizontally = centered_horizontally
alias centre_horizontally = centered_horizontally
alias centred_horizontally = centered_horizontally
alias centered_x = centered_horizontally
alias center_vertically = centered_vertically
alias centre_vertically = centered_vertically
alias centred_vertically = centered_vertically
alias centered_y = centered_vertically
alias centred_between = centered_between
alias halfway_between = centered_between
alias adjacent = touching
alias adjacent_to = touching
alias touch = touching

// Round things and lines touch by their curves, all else by its sides.
constraint touches(a: box, b: box) { touching(a, b) }
constraint touches(a: line, b: circle) { tangent(a, b) }
constraint touches(a: circle, b: line) { tangent(a, b) }
constraint touches(a: circle, b: circle) { tangent(a, b) }
constraint touches(a: line, b: arc) { tangent(a, b) }
constraint touches(a: arc, b: line) { tangent(a, b) }
constraint touches(a: arc, b: circle) { tangent(a, b) }
constraint touches(a: circle, b: arc) { tangent(a, b) }
constraint touches(a: arc, b: arc) { tangent(a, b) }
alias abuts = touching
alias not_overlapping = no_overlap
alias non_overlapping = no_overlap
alias no_overlaps = no_overlap
alias apart = no_overlap
alias separate = no_overlap
alias overlap = overlapping
alias intersecting = overlapping
alias above_of = above
alias below_of = below
alias on_left_of = left_of
alias on_the_left_of = left_of
alias on_right_of = right_of
alias on_the_right_of = right_of
alias enclosed_by = inside
alias enclosed_in = inside
alias contained_by = inside
alias containing = contains
alias does_not_overlap = no_overlap
alias no_intersection = no_overlap
alias disjoint = no_overlap
alias separated = no_overlap
alias separate_from = no_overlap
alias apart_from = no_overlap
alias intersects = overlapping
alias center_on = centered_in
alias centered_about = centered_in
alias centered_with = centered_in
alias horizontally_centered = centered_horizontally
alias vertically_centered = centered_vertically
