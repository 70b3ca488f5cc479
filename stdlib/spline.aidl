// Smooth curves through points, as Béziers.

/// A smooth curve through points, its knots: `segment[i]` runs from `knot[i]` to `knot[i + 1]`.
///
/// Through points of one circle it follows that circle closely. `closed: true` makes it an outline.
///
/// ```aidl
/// solid pebble { edge = spline((0, 0), (30, -5), (45, 15), (20, 30), (-5, 20), closed: true) }
/// ```
shape spline(points: list, closed: bool = false) {
    let n = len(points)
    assert n >= (if closed then 3 else 2), "a spline has at least two points, a closed one three"
    let last = if closed then n else n - 1
    let chord = [points[(i + 1) % n] - points[i] for i in 0..<last]
    for i in 0..<last {
        let a = written(chord[if closed or i > 0 then i - 1 else 0])
        let b = written(chord[i])
        let is_way_on = dot(a, b) + norm(a) * norm(b) > 0
        assert is_way_on, "neighbouring points of a spline differ, and it never turns straight back"
    }
    let way = [spline_way(chord, i, closed) for i in 0..<n]
    for i in 0..<n { knot[i] = points[i] }
    for i in 0..<last {
        let next = (i + 1) % n
        segment[i] = bezier(
            points[i],
            points[i] + spline_handle(way[i], chord[i]),
            points[next] - spline_handle(way[next], chord[i]),
            points[next]
        )
    }
    let start = points[0]
    let end = if closed then points[0] else points[-1]
}

// The direction in a knot is that of the circle through it and its neighbours; at an open end it mirrors that of the
// next knot about the chord between. A handle is as long as that of a Bézier along a circle, and no longer than its
// chord: where neighbouring chords are of very different lengths it would be endless.
fn spline_way(chord: list, i: integer, closed: bool) = if closed then circle_way(
    chord[(i + len(chord) - 1) % len(chord)], chord[i % len(chord)]
) else if len(chord) == 1 then chord[0] else if i == 0 then mirrored_way(
    circle_way(chord[0], chord[1]), chord[0]
) else if i == len(chord) then mirrored_way(
    circle_way(chord[i - 2], chord[i - 1]), chord[i - 1]
) else circle_way(chord[i - 1], chord[i])
fn circle_way(before: point, after: point) =
    unit(unit(before) * norm(after) + unit(after) * norm(before))
fn mirrored_way(way: point, chord: point) =
    unit(chord) * (2 * dot(way, unit(chord)) / 1mm / 1mm) - way
fn spline_handle(way: point, chord: point) =
    unit(way) * (norm(chord) * 2 / 3 / max(2mm / 3, 1mm + dot(unit(way), unit(chord)) / 1mm))
