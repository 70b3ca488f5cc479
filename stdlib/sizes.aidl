// Relations between the widths and heights of boxes.

// The box of a thing that has a size.
fn extent_of(of) = box(of)
fn extent_of(p: point) = has_no_size(p)
fn has_no_size(p: point) = refuse("a point has neither width nor height")

/// All are equally wide.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: (0, 0), width: guess(20), height: 10)
///     b = rectangle(center: (0, 20), width: 50, height: 10)
///     constrain same_width(a, b)
/// }
/// ```
constraint same_width(things: peers) {
    for i in 0..<len(things) - 1 { extent_of(things[i]).width == extent_of(things[-1]).width }
}

/// All are equally tall.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: (0, 0), width: 10, height: guess(20))
///     b = rectangle(center: (20, 0), width: 10, height: 50)
///     constrain same_height(a, b)
/// }
/// ```
constraint same_height(things: peers) {
    for i in 0..<len(things) - 1 { extent_of(things[i]).height == extent_of(things[-1]).height }
}

/// All are equally wide and equally tall.
///
/// ```aidl
/// drawing d {
///     a = rectangle(center: (0, 0), width: guess(20), height: guess(20))
///     b = ellipse(center: (60, 0), rx: 25, ry: 15)
///     constrain same_size(a, b)
/// }
/// ```
constraint same_size(things: peers) {
    same_width(things)
    same_height(things)
}

/// a is at least as wide as b; with `by`, wider by exactly so much.
///
/// ```aidl
/// drawing d {
///     base = rectangle(center: fixed((0, 0)), width: 40, height: 10)
///     roof = rectangle(center: (0, 30), width: guess(20), height: 6)
///     constrain wider(roof, base, by: 12)
/// }
/// ```
constraint wider(a: box, b: box) { a.width >= b.width }
constraint wider(a: box, b: box, by: length) { a.width == b.width + by }
constraint wider(a: box, b: box, at_least: length) { a.width >= b.width + at_least }
constraint wider(a: point, b: box) { has_no_size(a) }
constraint wider(a: box, b: point) { has_no_size(b) }

/// a is at most as wide as b; with `by`, narrower by exactly so much.
///
/// ```aidl
/// drawing d {
///     base = rectangle(center: fixed((0, 0)), width: 40, height: 10)
///     post = rectangle(center: (0, 30), width: guess(60), height: 30)
///     constrain narrower(post, base, by: 30)
/// }
/// ```
constraint narrower(a: box, b: box) { a.width <= b.width }
constraint narrower(a: box, b: box, by: length) { a.width == b.width - by }
constraint narrower(a: box, b: box, at_least: length) { a.width <= b.width - at_least }
constraint narrower(a: point, b: box) { has_no_size(a) }
constraint narrower(a: box, b: point) { has_no_size(b) }

/// a is at least as tall as b; with `by`, taller by exactly so much.
///
/// ```aidl
/// drawing d {
///     house = rectangle(center: fixed((0, 0)), width: 40, height: 30)
///     tower = rectangle(center: (30, 0), width: 12, height: guess(20))
///     constrain taller(tower, house, by: 20)
/// }
/// ```
constraint taller(a: box, b: box) { a.height >= b.height }
constraint taller(a: box, b: box, by: length) { a.height == b.height + by }
constraint taller(a: box, b: box, at_least: length) { a.height >= b.height + at_least }
constraint taller(a: point, b: box) { has_no_size(a) }
constraint taller(a: box, b: point) { has_no_size(b) }

/// a is at most as tall as b; with `by`, shorter by exactly so much.
///
/// ```aidl
/// drawing d {
///     house = rectangle(center: fixed((0, 0)), width: 40, height: 30)
///     shed  = rectangle(center: (40, 0), width: 20, height: guess(40))
///     constrain shorter(shed, house, by: 12)
/// }
/// ```
constraint shorter(a: box, b: box) { a.height <= b.height }
constraint shorter(a: box, b: box, by: length) { a.height == b.height - by }
constraint shorter(a: box, b: box, at_least: length) { a.height <= b.height - at_least }
constraint shorter(a: point, b: box) { has_no_size(a) }
constraint shorter(a: box, b: point) { has_no_size(b) }

/// a is at most as wide as b and at most as tall; of lines, a is no longer; of numbers, a is no greater.
///
/// With `by`, width and height (or the lengths) differ by exactly so much.
///
/// ```aidl
/// drawing d {
///     plate = rectangle(center: fixed((0, 0)), width: 40, height: 30)
///     lid   = rectangle(center: (60, 0), width: guess(50), height: guess(20))
///     constrain smaller(lid, plate)
/// }
/// ```
constraint smaller(a: box, b: box) {
    a.width <= b.width
    a.height <= b.height
}
constraint smaller(a: box, b: box, by: length) {
    a.width == b.width - by
    a.height == b.height - by
}
constraint smaller(a: box, b: box, at_least: length) {
    a.width <= b.width - at_least
    a.height <= b.height - at_least
}
constraint smaller(a: line, b: line) { a.length <= b.length }
constraint smaller(a: line, b: line, by: length) { a.length == b.length - by }
constraint smaller(a: line, b: line, at_least: length) { a.length <= b.length - at_least }
constraint smaller(a: length, b: length) { a <= b }
constraint smaller(a: angle, b: angle) { a <= b }
constraint smaller(a: number, b: number) { a <= b }
constraint smaller(a: point, b: box) { has_no_size(a) }
constraint smaller(a: box, b: point) { has_no_size(b) }

/// a is at least as wide as b and at least as tall: `smaller` the other way round.
///
/// ```aidl
/// drawing d {
///     plate = rectangle(center: fixed((0, 0)), width: 40, height: 30)
///     cover = rectangle(center: (60, 0), width: guess(30), height: guess(20))
///     constrain larger(cover, plate, by: 4)
/// }
/// ```
constraint larger(a: box, b: box) {
    a.width >= b.width
    a.height >= b.height
}
constraint larger(a: box, b: box, by: length) {
    a.width == b.width + by
    a.height == b.height + by
}
constraint larger(a: box, b: box, at_least: length) {
    a.width >= b.width + at_least
    a.height >= b.height + at_least
}
constraint larger(a: line, b: line) { a.length >= b.length }
constraint larger(a: line, b: line, by: length) { a.length == b.length + by }
constraint larger(a: line, b: line, at_least: length) { a.length >= b.length + at_least }
constraint larger(a: length, b: length) { a >= b }
constraint larger(a: angle, b: angle) { a >= b }
constraint larger(a: number, b: number) { a >= b }
constraint larger(a: point, b: box) { has_no_size(a) }
constraint larger(a: box, b: point) { has_no_size(b) }

alias equal_width = same_width
alias equal_widths = same_width
alias equal_height = same_height
alias equal_heights = same_height
alias equal_size = same_size
alias equal_sizes = same_size
alias wider_than = wider
alias narrower_than = narrower
alias taller_than = taller
alias shorter_than = shorter
alias smaller_than = smaller
alias less_than = smaller
alias at_most = smaller
alias no_larger_than = smaller
alias no_bigger_than = smaller
alias larger_than = larger
alias bigger = larger
alias bigger_than = larger
alias greater = larger
alias greater_than = larger
alias at_least = larger
alias no_smaller_than = larger
alias same_widths = same_width
alias same_heights = same_height
alias same_sizes = same_size
alias same_width_as = same_width
alias same_height_as = same_height
alias same_size_as = same_size
