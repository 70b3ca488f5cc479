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
fn clearance(a, b) = core_clearance(a, b, core(a), core(b))
fn core_clearance(a, b, p: list, q: list) = if len(p) > 0 and len(q) > 0 then shown(
    core_distance(p, q) - rounding(a) - rounding(b)
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
fn core_distance(a: list, b: list) = if len(a) == 1 and len(b) == 1 then norm(
    b[0] - a[0]
) else edge_distance(a, b, core_edges(a), core_edges(b))
fn edge_distance(a: list, b: list, of_a: list, of_b: list) = parted_or_deep(
    max(
        [beyond_edge(b, e[0], e[1], e[3]) for e in of_a] + [beyond_edge(
            a, e[0], e[1], e[3]
        ) for e in of_b]
    ),
    min([to_core(p, b, of_b) for p in a] + [to_core(p, a, of_a) for p in b])
)
fn parted_or_deep(parted, apart) = where(parted, apart, parted)

// The edges of a core: each a corner, the way to the one before, and its length, without and with the sign of
// the turn. An edge alone has two sides.
fn core_edges(core: list) = [core_edge(
    core[i], core[i - 1] - core[i], turn_of(core)
) for i in 0..<len(core) if len(core) > 1]
fn core_edge(corner: point, way: point, turn: number) = [corner, way, norm(way), norm(way) * turn]

// 1 for corners that run counter-clockwise, -1 for clockwise.
fn turn_of(core: list) =
    if len(core) < 3 then 1 else where(cross(core[1] - core[0], core[2] - core[1]), 1, -1)

// The distance of a corner from the edges of a core, and from one edge.
fn to_core(p: point, core: list, edges: list) = if len(core) == 1 then norm(p - core[0]) else min(
    [to_segment(p - e[0], e[1], e[2]) for e in edges]
)
fn to_segment(p: point, way: point, long: length) =
    norm(p - way * max(0, min(1, dot(p, way) / long / long)))

// By how much an edge has all corners of a core beyond it.
fn beyond_edge(corners: list, from: point, way: point, long: length) =
    min([cross(way, p - from) / long for p in corners])
