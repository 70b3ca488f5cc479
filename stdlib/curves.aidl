// Free curves from one point to another: waves, zigzags, S-shapes and spirals, to be drawn or made `thick`.

/// A wave like a sine's from `start` to `end`: `waves` periods, each up to its left by `amplitude` and then down.
///
/// `segment[i]` are its quarters, `knot[i]` where it crosses the straight way. `waves` may end in a half.
///
/// Lies with its first half on the left of its way.
///
/// ```aidl
/// drawing sea {
///     for i in 0..2 { swell[i] = wave(start: (0, -8 * i), end: (100, -8 * i), amplitude: 3, waves: 5) }
/// }
/// ```
shape wave(start: point, end: point, amplitude: length, waves = 1) {
    let halves = round(2 * written(waves))
    assert halves >= 1 and abs(halves - 2 * written(waves)) < 0.000001,
        "a wave has whole periods, or half a one at its end"
    let half = (end - start) / halves
    let left = turned(unit(end - start), 90deg) * (amplitude / 1mm)
    for i in 0..halves { knot[i] = lerp(start, end, i / halves) }
    for i in 0..<halves {
        let up = if i % 2 == 0 then left else -left
        fn place(x, y) = knot[i] + half * x + up * y
        segment[2 * i] = bezier(
            knot[i], place(sine_foot, pi * sine_foot), place(sine_crest, 1), place(0.5, 1)
        )
        segment[2 * i + 1] = bezier(
            place(0.5, 1),
            place(1 - sine_crest, 1),
            place(1 - sine_foot, pi * sine_foot),
            knot[i + 1]
        )
    }
}

// How far along half a period the handles of the cubic lie that follows a quarter of a sine to 1/10,000 of its height.
let sine_foot = 0.163
let sine_crest = 0.319

/// A zigzag from `start` to `end` of `waves` teeth, each up to its left by `amplitude` and then down: a stroke of lines.
///
/// Its lines are `outline.edges[i]`. As a spring or a resistor is drawn, or a saw's edge.
///
/// ```aidl
/// drawing resistor {
///     before = line((0, 0), (10, 0))
///     body = zigzag(start: before.end, end: (50, 0), amplitude: 4, waves: 6)
///     behind = line(body.end, (60, 0))
/// }
/// ```
shape zigzag(start: point, end: point, amplitude: length, waves: integer = 4) {
    assert waves >= 1, "a zigzag has at least one tooth"
    let left = turned(unit(end - start), 90deg) * (amplitude / 1mm)
    fn crest(i) = lerp(start, end, (i + 0.5) / (2 * waves)) + left * (if i % 2 == 0 then 1 else -1)
    outline = polyline([start] + [crest(i) for i in 0..<2 * waves] + [end])
    let edges = outline.edges
}

/// An S from `start` to `end`: two equal arcs, `first` and `second`, that leave and arrive level, or upright on request.
///
/// As a moulding, a bottle's shoulder or a bent pipe needs it.
///
/// ```aidl
/// solid pipe {
///     way = s_curve(start: (0, 0), end: (50, 24))
///     body = thick(way, 6)
/// }
/// ```
shape s_curve(start: point, end: point, upright: bool = false) {
    let dx = end.x - start.x
    let dy = end.y - start.y
    assert abs(written(if upright then dx else dy)) > 0.000001 * norm(written(end - start)),
        "an S goes aside: straight ahead go a `wave` and a `line`"
    let radius = (dx ^ 2 + dy ^ 2) / (4 * (if upright then dx else dy))
    let reach = if upright then (radius, 0) else (0, radius)
    let is_left_first = (written(dx) * written(dy) > 0) != upright
    let middle = (start + end) / 2
    first = arc(center: start + reach, start: start, end: middle, clockwise: not is_left_first)
    second = arc(center: end - reach, start: middle, end: end, clockwise: is_left_first)
}

/// A spiral about `center` from `start_radius` to `end_radius` in a number of `turns`, counter-clockwise or clockwise.
///
/// Its radius grows evenly; it begins at `start_angle`. `segment[i]` are eight pieces for each turn; `thick(…)` makes
/// a scroll or a clock spring of it.
///
/// ```aidl
/// solid hypnosis {
///     way = spiral(start_radius: 2, end_radius: 30, turns: 4)
///     band = thick(way, 3)
/// }
/// ```
shape spiral(
    center: point = (0, 0),
    start_radius: length,
    end_radius: length,
    turns = 3,
    start_angle: turn = 0deg,
    clockwise: bool = false
) {
    let pieces = ceil(8 * written(turns) - 0.000001)
    assert pieces >= 1, "a spiral turns"
    let piece = 360deg * turns / pieces * (if clockwise then -1 else 1)
    let growth = (end_radius - start_radius) / pieces
    for i in 0..pieces {
        knot[i] = center + polar(start_radius + growth * i, start_angle + piece * i)
    }
    for i in 0..<pieces {
        segment[i] = bezier(
            knot[i],
            knot[i] + spiral_way(start_radius + growth * i, growth, piece, start_angle + piece * i),
            knot[i + 1] - spiral_way(
                start_radius + growth * (i + 1), growth, piece, start_angle + piece * (i + 1)
            ),
            knot[i + 1]
        )
    }
    let start = knot[0]
    let end = knot[pieces]
}

// A handle: along the tangent of the spiral, so long that without growth the piece is as near a circle as can be.
fn spiral_way(radius: length, growth: length, sweep: angle, at_angle: angle) =
    turned((growth / 3, radius * (4 / 3 * tan(sweep / 4))), at_angle)

alias sine = wave
alias sine_wave = wave
alias wavy_line = wave
alias squiggle = wave
alias sawtooth = zigzag
alias ogee = s_curve
alias s_bend = s_curve
alias cyma = s_curve
alias scroll = spiral
alias volute = spiral
