// The room between outlines. Where a closed form exists it can be constrained.
//
// Everything that has one is a convex core with a rounding: a circle is its centre and a radius, a slot the
// line between the centres of its ends and half its width, a rectangle its corners and nothing.

/// The room between the outlines of two things: how far they are apart where they are nearest.
///
/// Points, lines (from end to end), circles, slots and convex shapes with straight sides can be constrained:
/// there, less than 0 is how deep they overlap. Anything else, structures with their holes among it, is
/// measured on the finished drawing, in an `assert`, where the room is never less than 0.
///
/// ```aidl
/// drawing pads {
///     pad  = rectangle(center: origin, width: 30, height: 20, angle: fixed(30deg))
///     hole = circle(center: (25, 10), radius: 5)
///     constrain clearance(hole, pad) == 4
///     assert clearance(hole, pad) == 4
/// }
/// ```
fn clearance(a, b) = if len(core(a)) > 0 and len(core(b)) > 0 then shown(
    core_distance(core(a), core(b)) - rounding(a) - rounding(b)
) else outline_clearance(a, b)

alias outline_distance = clearance

// The corners of the core, in order; none where there is no closed form.
fn core(of) = convex_corners(of)
fn core(p: point) = [p]
fn core(l: line) = [l.start, l.end]
fn core(c: circle) = [c.center]
fn core(s: slot) = [s.start, s.end]
fn core(r: rounded_rectangle) = [
    r.bottom.start + (0, r.radius),
    r.bottom.end + (0, r.radius),
    r.top.start - (0, r.radius),
    r.top.end - (0, r.radius)
]

// How far the outline runs outside the core.
fn rounding(of) = 0mm
fn rounding(c: circle) = c.radius
fn rounding(s: slot) = s.width / 2
fn rounding(r: rounded_rectangle) = r.radius

// The distance of two convex cores: that of the nearest corner and edge where a line parts them; else, less
// than 0, the shortest way to part them.
fn core_distance(a: list, b: list) = if len(a) == 1 and len(b) == 1 then norm(b[0] - a[0]) else where(
    parted(a, b),
    min([to_core(p, b) for p in a] + [to_core(p, a) for p in b]),
    parted(a, b)
)

// The distance of a corner from the edges of a core, and from one edge.
fn to_core(p: point, core: list) = min(
    [to_segment(p, core[i], core[(i + 1) % len(core)]) for i in 0..<len(core)]
) if len(core) > 1 else norm(p - core[0])
fn to_segment(p: point, a: point, b: point) = norm(
    p - a - (b - a) * max(0, min(1, dot(p - a, b - a) / dot(b - a, b - a)))
)

// By how much the edge that parts two cores best does so: less than 0 when none does.
fn parted(a: list, b: list) = max(beyond_edges(a, b) + beyond_edges(b, a))
fn beyond_edges(core: list, points: list) = [
    min([turn_of(core) * offset_right(p, core[i], core[(i + 1) % len(core)]) for p in points])
    for i in 0..<len(core) if len(core) > 1
]
fn offset_right(p: point, a: point, b: point) = cross(p - a, b - a) / norm(b - a)

// 1 for corners that run counter-clockwise, -1 for clockwise; an edge alone has two sides.
fn turn_of(core: list) = if len(core) < 3 then 1 else where(
    cross(core[1] - core[0], core[2] - core[1]),
    1,
    -1
)
