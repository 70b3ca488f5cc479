// Outlines written as a pen draws them, one step after the other. A step is a record: what `kind` it is and where it
// goes; the path turns steps into segments that share their ends.

// With a heading that was stated or not: a curve at the beginning sets out as it likes best unless it was.
shape path(steps: list, from: point, heading: turn, is_aimed: bool, closed: bool) {
    let drawn = [as_step(s) for s in steps if not as_step(s).kind in last_kinds]
    assert len(drawn) >= 1, "a path has at least one step that draws"
    let endings = [as_step(s) for s in steps if as_step(s).kind in last_kinds]
    let ending = if len(endings) > 0 then endings[0] else record(kind: "none")
    let closes = closed or ending.kind == "close"
    if ending.kind == "mirrored" {
        let is_last = len(endings) == 1 or len(endings) == 2 and endings[1].kind == "close"
        assert is_last and as_step(steps[len(drawn)]).kind == "mirrored",
            "`mirrored()` is the last step"
    } else if len(endings) > 0 {
        assert len(endings) == 1 and as_step(steps[-1]).kind == "close",
            "`close()` is the last step"
    }
    corner[0] = from
    for i in 0..<len(drawn) {
        let move = drawn[i]
        let pen = corner[i]
        let way = if i == 0 then polar(1mm, heading) else leaving(segment[i - 1])
        let run = if move.kind in run_kinds then drawn[i + move.left[0]] else move
        let is_run_home = move.kind in run_kinds and i + move.left[0] == len(drawn) - 1 and meets(
            run.to, from
        )
        let goal = if is_run_home then from else if move.kind in run_kinds then run.to else pen
        let reached = if move.kind in run_kinds then run_end(
            move, if move.kind == "tooth_fall" then corner[i - 1] else pen, goal, run.height
        ) else step_end(move, pen, way, from)
        let is_home = i == len(drawn) - 1 and meets(reached, from)
        // What ends at a point of its own ends at the start itself; what ends after a way is made to meet it.
        let is_there = is_home and move.kind in placed_kinds
        let to = if is_there then from else reached
        if is_home and not is_there { constrain reached == from }

        let is_half = move.kind == "arc_radius" and abs(
            written(norm(to - pen) - 2 * move.radius)
        ) < 0.000001
        if move.kind == "slanted" {
            assert false, "the edges of a rectilinear polygon are level and upright in turns"
        } else if move.kind == "arc_tangent" {
            let aside = written(dot(to_left(way), to - pen)) / 1mm
            assert abs(aside) > 0.000001,
                "`tangent_arc_to` goes to a point straight ahead, where `line_to` goes"
        } else if move.kind == "arc_by" {
            assert 0deg < abs(written(move.turn)) < 360deg,
                "`arc_by` turns by less than a whole turn, and not by 0"
        }
        if move.kind in ["arc_by", "arc_radius"] {
            assert written(move.radius) > 0, "the radius of an arc is more than 0"
        }

        if move.kind == "smooth_to" {
            assert norm(written(to - pen)) > 0.000001,
                "`smooth_to` goes to another point than where it is"
            let chord = to - pen
            let next = if i < len(drawn) - 1 then drawn[i + 1] else record(kind: "none")
            let has_image = ending.kind == "mirrored"
            let goes_home = is_home and not has_image
            let goes_over = has_image and ending.smooth and i == len(drawn) - 1
            let comes_home = i == 0 and not has_image and comes_smoothly(drawn, from)
            let arrival = if move.is_aimed then polar(
                1mm, move.heading
            ) else if next.kind == "smooth_to" and not next.is_leaving then circle_way(
                chord, next.to - to
            ) else if next.kind in straight_kinds then step_end(
                next, to, chord, from
            ) - to else if goes_home then entering(segment[0]) else if goes_over then across(
                if ending.is_told then ending.about.end - ending.about.start else to - from, chord
            ) else chord
            let is_arrival_free = not (move.is_aimed or goes_home or goes_over or next.kind in straight_kinds) and (next.kind != "smooth_to" or next.is_leaving)
            let departure = if move.is_leaving then polar(
                1mm, move.leaving
            ) else if i > 0 or is_aimed then way else if comes_home then circle_way(
                from - drawn[-2].to, chord
            ) else mirrored_way(unit(arrival), chord)
            let last = if is_arrival_free then mirrored_way(unit(departure), chord) else arrival
            segment[i] = bezier(
                pen,
                pen + smooth_handle(departure, last, chord),
                to - smooth_handle(last, departure, chord),
                to
            )
        } else if move.kind == "bezier_to" {
            segment[i] = bezier(pen, move.first, move.second, to)
        } else if move.kind in ["wave_left", "wave_right"] {
            let aside = to_left(to - pen) * (run.height / 0.75mm)
            let up = if move.kind == "wave_left" then aside else -aside
            let along = (to - pen) * (4 / 3 / pi)
            segment[i] = bezier(pen, pen + along + up, to - along + up, to)
        } else if move.kind == "half_circle" {
            segment[i] = arc(center: (pen + to) / 2, start: pen, end: to, clockwise: true)
        } else if move.kind == "scallop" {
            let chord = to - pen
            segment[i] = arc(
                center: (pen + to) / 2 + to_left(chord) * ((run.height ^ 2 - dot(
                    chord, chord
                ) / 4) / (2 * run.height) / 1mm),
                start: pen,
                end: to,
                clockwise: written(run.height) > 0mm
            )
        } else if move.kind == "quadratic_to" {
            segment[i] = bezier(pen, lerp(pen, move.by, 2 / 3), lerp(to, move.by, 2 / 3), to)
        } else if is_half {
            segment[i] = arc(center: (pen + to) / 2, start: pen, end: to, clockwise: move.clockwise)
            constrain segment[i].radius == move.radius
        } else if move.kind == "arc_radius" {
            segment[i] = arc(
                start: pen,
                end: to,
                radius: move.radius,
                large: move.large,
                clockwise: move.clockwise
            )
        } else if move.kind in ["arc_center", "arc_through", "arc_by", "arc_tangent"] {
            let hub = arc_hub(move, pen, way, to)
            let clockwise = is_clockwise(move, pen, way, to)
            segment[i] = arc(center: hub, start: pen, end: to, clockwise: clockwise)
        } else {
            segment[i] = line(pen, to)
        }
        if not is_home { corner[i + 1] = to }
        if move.smooth and i > 0 { constrain smoothly(segment[i - 1], segment[i]) }
    }
    let half = len(drawn)
    if half > 0 and closes and ending.kind != "mirrored" and not meets(segment[-1].end, from) {
        segment[half] = line(corner[half], from)
        if ending.kind == "close" and ending.smooth {
            constrain smoothly(segment[half - 1], segment[half])
        }
    }
    if half > 0 and ending.kind == "mirrored" and meets(segment[-1].end, from) {
        assert false, "the half that `mirrored()` completes does not end where it starts"
    } else if half > 0 and ending.kind == "mirrored" {
        let far = segment[half - 1].end
        let axis = if ending.is_told then ending.about else line(from, far)
        let starts_there = meets(from, mirror(from, about: axis))
        let turns_there = meets(far, mirror(far, about: axis))
        if ending.is_told {
            if starts_there { constrain offset_from(from, axis) == 0 }
            if turns_there { constrain offset_from(far, axis) == 0 }
        } else if abs(written(far.x - from.x)) < 0.000001 {
            constrain far.x == from.x
        } else if abs(written(far.y - from.y)) < 0.000001 {
            constrain far.y == from.y
        }
        if not turns_there {
            corner[half + 1] = mirror(far, about: axis)
            segment[half] = line(far, corner[half + 1])
        }
        let joint = len(segment)
        for i in 0..<half {
            let j = half - 1 - i
            if j > 0 {
                corner[joint + i + 1] = mirror(corner[j], about: axis)
            } else if not starts_there {
                corner[joint + i + 1] = mirror(from, about: axis)
            }
            let home = if j == 0 and starts_there then from else corner[joint + i + 1]
            segment[joint + i] = mirrored_back(segment[j], axis, corner[joint + i], home)
        }
        if ending.smooth and drawn[-1].kind != "smooth_to" {
            constrain squarely(segment[half - 1], axis)
        }
        if ending.closed and not starts_there {
            segment[joint + half] = line(corner[joint + half], from)
        }
    }
    let end = segment[-1].end
    if half > 0 and drawn[0].smooth {
        assert meets(end, from), "the first step of an open path has nothing to go on from smoothly"
        constrain smoothly(segment[-1], segment[0])
    }
    let start = from
    let points = corner
    let edges = segment
}

/// An outline drawn step by step: `segment[i]` runs from `corner[i]` to `corner[i + 1]`.
///
/// Steps are `line_to`, `line_by`, `up`, `down`, `left`, `right`, `forward`, `horizontal_to`, `vertical_to`, `arc_to`,
/// `arc_by`, `tangent_arc_to`, `smooth_to`, `bezier_to`, `quadratic_to`, `polyline_to`, `wave_to`, `zigzag_to`,
/// `scallops_to`, `close` and `mirrored`; a plain point is a `line_to`. `smooth: true` on a step makes its segment go on in the direction of the one before. A path that ends
/// where it starts is closed; `close()` closes one that does not with a line, `mirrored()` with its own mirror image.
/// `heading` is the direction before the first step. Steps that recur stand in `for i in 0..9 { … }` among the others.
///
/// ```aidl
/// solid tag {
///     edge = path(
///         from: (0, 0),
///         line_to((40, 0)),
///         arc_to((40, 20), radius: 10),
///         line_to((0, 20)),
///         close()
///     )
/// }
/// ```
fn path(steps: list, from: point, closed: bool = false) = path(steps, from, 0deg, false, closed)
fn path(steps: list, from: point, heading: angle, closed: bool = false) =
    path(steps, from, heading, true, closed)

/// By `start:`, or with the start as the first argument.
fn path(steps: list, start: point, closed: bool = false) = path(steps, from: start, closed: closed)
fn path(steps: list, start: point, heading: angle, closed: bool = false) =
    path(steps, from: start, heading: heading, closed: closed)
fn path(steps: list, closed: bool = false) =
    path([steps[i] for i in 1..<len(steps)], from: steps[0], closed: closed)
fn path(steps: list, heading: angle, closed: bool = false) =
    path([steps[i] for i in 1..<len(steps)], from: steps[0], heading: heading, closed: closed)

let placed_kinds = [
    "line_to",
    "smooth_to",
    "bezier_to",
    "quadratic_to",
    "arc_radius",
    "arc_center",
    "arc_through",
    "arc_tangent"
] + run_kinds

// The steps of a run of equal ones. `left` has how many steps and how many periods are left of it; the last step has what
// holds for all.
let run_kinds = ["wave_left", "wave_right", "tooth_rise", "tooth_fall", "half_circle", "scallop"]
fn run_end(
    move: record, start: point, goal: point, height: length
) = if move.kind == "tooth_rise" then lerp(start, goal, 0.5 / move.left[1]) + to_left(
    goal - start
) * (height / 1mm) else lerp(
    start, goal, 1 / (if move.kind == "tooth_fall" then move.left[1] else move.left[0] + 1)
)
fn run_to(kinds: list, to: point, height: length, periods: integer) = [run_step(
    kinds[k % len(kinds)],
    [len(kinds) * periods - 1 - k, periods - floor(k / len(kinds))],
    to,
    height
) for k in 0..<len(kinds) * periods]
fn run_step(kind: text, left: list, to: point, height: length) = if left[0] == 0 then record(
    kind: kind, left: left, to: to, height: height, smooth: false
) else record(kind: kind, left: left, smooth: false)

let last_kinds = ["close", "mirrored"]

// The steps whose direction is known before they are drawn.
let straight_kinds = ["line_to", "line_by", "line_along", "level_to", "upright_to"]

// Whether the last of some steps goes smoothly into the first one.
fn comes_smoothly(drawn: list, start: point) = len(
    drawn
) > 2 and drawn[-1].kind == "smooth_to" and drawn[-2].kind in placed_kinds and not drawn[-1].is_aimed and meets(
    drawn[-1].to, start
)
// The direction square to an axis on the side to which a way leads.
fn across(axis: point, way: point) =
    turned(axis, if cross(written(axis), written(way)) >= 0mm * 1mm then 90deg else -90deg)
// Where the tangents at both ends cross ahead, a handle ends there at the latest: so the curve stays in their corner.
fn smooth_handle(way: point, other: point, chord: point) = unit(way) * (if norm(
    written(chord)
) > 0.000001 and cuts_corner(written(way), written(other), written(chord)) then min(
    round_share(way, chord), corner_share(way, other, chord)
) else round_share(way, chord))
fn round_share(way: point, chord: point) =
    norm(chord) * 2 / 3 / max(0.5mm, 1mm + dot(unit(way), unit(chord)) / 1mm)
fn corner_share(way: point, other: point, chord: point) =
    cross(chord, unit(other)) / cross(unit(way), unit(other))
fn cuts_corner(way: point, other: point, chord: point) =
    do_turn_alike(way, chord, other) and do_turn_alike(other, chord, way)
fn do_turn_alike(way: point, first: point, second: point) =
    cross(way, first) * cross(way, second) > 0.000001 * dot(way, way) * norm(first) * norm(second)

fn as_step(move: record) = move
fn as_step(p: point) = line_to(p)

// Whether two points are one as they were written.
fn meets(a: point, b: point) = norm(written(a - b)) < 0.000001

// The mirror image of a segment, which runs the other way.
fn mirrored_back(l: line, axis: line, start: point, end: point) = line(start, end)
fn mirrored_back(a: arc, axis: line, start: point, end: point) =
    arc(center: mirror(a.center, about: axis), start: start, end: end, clockwise: is_clockwise(a))
fn mirrored_back(b: bezier, axis: line, start: point, end: point) =
    bezier(start, mirror(b.p2, about: axis), mirror(b.p1, about: axis), end)

// Where a step that begins at `pen` in the direction `way` ends.
fn step_end(
    move: record, pen: point, way: point, start: point
) = if move.kind == "line_by" then pen + (move.dx, move.dy) else if move.kind == "line_along" then pen + polar(
    move.length, move.angle
) else if move.kind == "forward" then pen + turned(
    unit(way), move.turn
) * (move.distance / 1mm) else if move.kind == "level_to" then (move.to.x, pen.y) else if move.kind == "upright_to" then (pen.x, move.to.y) else if move.kind == "level_home" then (start.x, pen.y) else if move.kind == "upright_home" then (pen.x, start.y) else if move.kind == "arc_by" then turned_about(
    arc_hub(move, pen, way, pen), pen, move.turn
) else move.to
fn turned_about(hub: point, p: point, angle: angle) = hub + turned(p - hub, angle)

// The centre of an arc that begins at `pen` in the direction `way`.
fn arc_hub(
    move: record, pen: point, way: point, to: point
) = if move.kind == "arc_center" then move.center else if move.kind == "arc_through" then circumcenter(
    pen, move.through, to
) else if move.kind == "arc_by" then pen + to_left(way) * (move.radius * (if written(
    move.turn
) >= 0deg then 1 else -1) / 1mm) else pen + to_left(way) * (dot(to - pen, to - pen) / (2 * dot(
    to_left(way), to - pen
)))
fn to_left(way: point) = turned(unit(way), 90deg)
fn is_clockwise(
    move: record, pen: point, way: point, to: point
) = if move.kind == "arc_center" then move.clockwise else if move.kind == "arc_through" then cross(
    written(move.through - pen), written(to - pen)
) < 0 else if move.kind == "arc_by" then written(move.turn) < 0deg else cross(
    written(way), written(to - pen)
) < 0

// The directions in which a segment begins and ends.
fn entering(l: line) = l.end - l.start
fn entering(a: arc) = turned(a.start - a.center, quarter_of(a))
fn entering(b: bezier) = b.p1 - b.p0
fn leaving(l: line) = l.end - l.start
fn leaving(a: arc) = turned(a.end - a.center, quarter_of(a))
fn leaving(b: bezier) = b.p3 - b.p2
fn quarter_of(a: arc) =
    if cross(written(a.midpoint - a.start), written(a.end - a.start)) >= 0 then 90deg else -90deg

constraint smoothly(a, b) {
    cross(leaving(a), entering(b)) / norm(leaving(a)) / norm(entering(b)) == 0
}

// A segment ends square to the axis, so that it goes on without a corner into its mirror image.
constraint squarely(a, axis: line) {
    dot(leaving(a), axis.end - axis.start) / norm(leaving(a)) / axis.length == 0
}

// --- Steps ---------------------------------------------------------------------------------------

/// A step of a path: straight to a point.
///
/// ```aidl
/// solid kite { edge = path(from: (0, 0), line_to((20, 10)), line_to((50, 0)), line_to((20, -10)), close()) }
/// ```
fn line_to(to: point, smooth: bool = false) = record(kind: "line_to", to: to, smooth: smooth)
fn line_to(x: length, y: length, smooth: bool = false) = line_to((x, y), smooth: smooth)

/// A step of a path: straight by a way, or by a length and a direction.
///
/// ```aidl
/// solid ramp { edge = path(from: (0, 0), line_by((40, 0)), line_by(length: 20, angle: 120deg), close()) }
/// ```
fn line_by(way: point, smooth: bool = false) = line_by(dx: way.x, dy: way.y, smooth: smooth)
fn line_by(dx: length, dy: length, smooth: bool = false) =
    record(kind: "line_by", dx: dx, dy: dy, smooth: smooth)
fn line_by(length: length, angle: angle, smooth: bool = false) =
    record(kind: "line_along", length: length, angle: angle, smooth: smooth)

/// A step of a path: to the right, exactly level. Of a point, the place as far to the right of it: `plate.top_left.right(27)`.
///
/// ```aidl
/// solid stair { edge = path(from: (0, 0), right(30), up(10), left(15), up(10), left(15), close()) }
/// ```
fn right(distance: length, smooth: bool = false) =
    line_by(dx: distance, dy: fixed(0), smooth: smooth)
fn right(from: point, distance: length) = from + (distance, 0)

/// A step of a path: to the left, exactly level. Of a point, the place as far to the left of it: `plate.top_left.left(27)`.
///
/// ```aidl
/// solid flag { edge = path(from: (0, 0), line_to((30, 5)), up(20), left(30), close()) }
/// ```
fn left(distance: length, smooth: bool = false) = right(-distance, smooth: smooth)
fn left(from: point, distance: length) = from + (-distance, 0)

/// A step of a path: upwards, exactly upright. Of a point, the place as far above it: `plate.top_left.up(27)`.
///
/// ```aidl
/// solid wedge { edge = path(from: (0, 0), right(30), up(15), close()) }
/// ```
fn up(distance: length, smooth: bool = false) = line_by(dx: fixed(0), dy: distance, smooth: smooth)
fn up(from: point, distance: length) = from + (0, distance)

/// A step of a path: downwards, exactly upright. Of a point, the place as far below it: `plate.top_left.down(27)`.
///
/// ```aidl
/// solid notch { edge = path(from: (0, 0), right(30), down(15), left(10), up(5), left(20), close()) }
/// ```
fn down(distance: length, smooth: bool = false) = up(-distance, smooth: smooth)
fn down(from: point, distance: length) = from + (0, -distance)

/// A step of a path: straight on, after turning to the left by `turn`.
///
/// ```aidl
/// solid hexagon {
///     edge = path(from: (0, 0), forward(20), [forward(20, turn: 60deg) for i in 1..4], close())
/// }
/// ```
fn forward(distance: length, turn: angle = 0deg, smooth: bool = false) =
    record(kind: "forward", distance: distance, turn: turn, smooth: smooth)

/// A step of a path: level, as far as an x.
///
/// ```aidl
/// solid stairs {
///     edge = path(
///         from: (0, 0),
///         horizontal_to(30), vertical_to(10), horizontal_to(10), vertical_to(20), horizontal_to(0), close()
///     )
/// }
/// ```
fn horizontal_to(x: length, smooth: bool = false) =
    record(kind: "level_to", to: (x, fixed(0)), smooth: smooth)

/// A step of a path: upright, as far as a y.
///
/// ```aidl
/// solid gable { edge = path(from: (0, 0), right(40), vertical_to(20), line_to((20, 35)), line_to((0, 20)), close()) }
/// ```
fn vertical_to(y: length, smooth: bool = false) =
    record(kind: "upright_to", to: (fixed(0), y), smooth: smooth)

/// A step of a path: straight through several points.
///
/// ```aidl
/// solid zigzag { edge = path(from: (0, 0), right(40), polyline_to([(30, 10), (20, 5), (10, 10)]), close()) }
/// ```
fn polyline_to(points: list) = [line_to(p) for p in points]

/// A step of a path: an arc to a point by its `radius`, its `center`, or a point that it goes `through`.
///
/// It runs counter-clockwise unless it is `clockwise: true`; by a radius it is the shorter one unless `large: true`.
///
/// ```aidl
/// solid plate {
///     edge = path(
///         from: (0, 0),
///         arc_to((40, 0), radius: 30),
///         arc_to((40, 20), center: (40, 10)),
///         arc_to((0, 20), through: (20, 14)),
///         close()
///     )
/// }
/// ```
fn arc_to(
    to: point, radius: length, large: bool = false, clockwise: bool = false, smooth: bool = false
) = record(
    kind: "arc_radius", to: to, radius: radius, large: large, clockwise: clockwise, smooth: smooth
)
fn arc_to(to: point, center: point, clockwise: bool = false, smooth: bool = false) =
    record(kind: "arc_center", center: center, to: to, clockwise: clockwise, smooth: smooth)
fn arc_to(to: point, through: point, smooth: bool = false) =
    record(kind: "arc_through", through: through, to: to, smooth: smooth)

/// A step of a path: an arc that goes on without a corner and turns by an angle, clockwise if it is negative.
///
/// ```aidl
/// solid hook {
///     edge = path(from: (0, 0), right(40), arc_by(180deg, radius: 15), forward(20), close())
/// }
/// ```
fn arc_by(turn: angle, radius: length, smooth: bool = true) =
    record(kind: "arc_by", turn: turn, radius: radius, smooth: false)

/// A step of a path: the arc to a point that goes on without a corner.
///
/// ```aidl
/// solid paddle { edge = path(from: (0, 0), line_to((40, 5)), tangent_arc_to((40, -5)), close()) }
/// ```
fn tangent_arc_to(to: point, smooth: bool = true) =
    record(kind: "arc_tangent", to: to, smooth: false)

/// A step of a path: a smooth curve to a point, which leaves and arrives without a corner where nothing else is said.
///
/// Several are one smooth curve through their points, its knots. It goes on from the step before and into a straight
/// step behind it; into the first step where it closes the outline, and square to the axis of `mirrored(smooth: true)`.
/// `heading` is its direction at its end, `leaving` that at its start, where the path may have a corner then. Without
/// `leaving` the first step of an open path sets out in the path's `heading`, or, where it has none, as an arc does:
/// turned from its chord as much as it arrives. It stays in the corner of its two directions, where they have one ahead.
///
/// ```aidl
/// solid pear {
///     body = path(
///         from: (0, 0),
///         smooth_to((22, 18), leaving: 0deg),
///         smooth_to((9, 46)),
///         smooth_to((0, 56), heading: 180deg),
///         mirrored(about: y_axis)
///     )
/// }
/// ```
fn smooth_to(to: point) = smooth_step(to, 0deg, false, 0deg, false)
fn smooth_to(to: point, heading: angle) = smooth_step(to, heading, true, 0deg, false)
fn smooth_to(to: point, leaving: angle) = smooth_step(to, 0deg, false, leaving, true)
fn smooth_to(to: point, heading: angle, leaving: angle) =
    smooth_step(to, heading, true, leaving, true)
fn smooth_step(
    to: point, heading: angle, is_aimed: bool, leaving: angle, is_leaving: bool
) = record(
    kind: "smooth_to",
    to: to,
    heading: heading,
    is_aimed: is_aimed,
    leaving: leaving,
    is_leaving: is_leaving,
    smooth: false
)

/// A step of a path: in `waves` whole waves to a point, each first to the left of its way by `amplitude`, then to the right.
///
/// ```aidl
/// assembly sea {
///     @color("steelblue")
///     solid water {
///         body = path(from: (0, 0), right(90), up(20), wave_to((0, 20), amplitude: 3, waves: 5), close())
///     }
/// }
/// ```
fn wave_to(to: point, amplitude: length, waves: integer = 4) = if waves >= 1 then run_to(
    ["wave_left", "wave_right"], to, amplitude, waves
) else refuse("a wave has at least one period")

/// A step of a path: to a point over `teeth` pointed teeth, `height` high on the left of its way, on the right if negative.
///
/// ```aidl
/// solid crown {
///     body = path(from: (0, 0), right(50), up(18), zigzag_to((0, 18), height: -14, teeth: 5), close())
/// }
/// ```
fn zigzag_to(to: point, height: length, teeth: integer = 4) = if teeth >= 1 then run_to(
    ["tooth_rise", "tooth_fall"], to, height, teeth
) else refuse("a zigzag has at least one tooth")

/// A step of a path: to a point over `n` equal arcs that bulge by `depth` to the left of its way, to the right if negative.
///
/// Without a depth they are half circles.
///
/// ```aidl
/// solid awning {
///     body = path(from: (0, 0), line_to((8, 30)), right(64), line_to((80, 0)), scallops_to((0, 0), n: 8, depth: 4))
/// }
/// ```
fn scallops_to(to: point, n: integer) =
    if n >= 1 then run_to(["half_circle"], to, 0mm, n) else refuse("there is at least one scallop")
fn scallops_to(to: point, n: integer, depth: length) = if n < 1 then refuse(
    "there is at least one scallop"
) else if abs(written(depth)) > 0.000001 then run_to(["scallop"], to, depth, n) else refuse(
    "scallops bulge: their depth is not 0"
)

/// A step of a path: a cubic Bézier by its two control points and its end.
///
/// ```aidl
/// solid wave {
///     edge = path(from: (0, 0), bezier_to((15, 20), (30, -10), (45, 10)), vertical_to(-15), left(45), close())
/// }
/// ```
fn bezier_to(first: point, second: point, to: point, smooth: bool = false) =
    record(kind: "bezier_to", first: first, second: second, to: to, smooth: smooth)

/// A step of a path: a quadratic Bézier by its control point and its end.
///
/// ```aidl
/// solid arch { edge = path(from: (0, 0), quadratic_to((20, 40), (40, 0)), close()) }
/// ```
fn quadratic_to(by: point, to: point, smooth: bool = false) =
    record(kind: "quadratic_to", by: by, to: to, smooth: smooth)

/// The last step of a path: straight back to where it starts, unless it is there.
///
/// ```aidl
/// solid sail { edge = path(from: (0, 0), right(25), line_to((0, 60)), close()) }
/// ```
fn close(smooth: bool = false) = record(kind: "close", smooth: smooth)

/// The last step of a path: back to where it starts as the mirror image of all steps before it.
///
/// The axis is the line through both ends of the half, which stays level or upright if it is written so, or `about` a
/// line, `x` or `y`. Ends that are written on the axis stay on it; others are joined with their images by lines, at the
/// start unless `closed: false`. `smooth: true` leaves no corner where the image begins.
///
/// ```aidl
/// solid vase {
///     body = path(from: (0, 0), right(15), arc_to((8, 40), radius: 30), line_to((12, 50)), mirrored(about: y_axis))
/// }
/// ```
fn mirrored(closed: bool = true, smooth: bool = false) =
    record(kind: "mirrored", about: "y", is_told: false, closed: closed, smooth: smooth)
fn mirrored(about: line, closed: bool = true, smooth: bool = false) =
    record(kind: "mirrored", about: about, is_told: true, closed: closed, smooth: smooth)
fn mirrored(about: text, closed: bool = true, smooth: bool = false) =
    record(kind: "mirrored", about: axis_of(about), is_told: true, closed: closed, smooth: smooth)
alias close_mirrored = mirrored

/// The start of a path, as its first argument.
///
/// ```aidl
/// solid shard { edge = path(move_to(5, 0), line_to(30, 10), line_to(0, 25), close()) }
/// ```
fn move_to(to: point) = to
fn move_to(x: length, y: length) = (x, y)

// --- Level and upright outlines ------------------------------------------------------------------

/// A closed outline of level and upright edges through its corners; it stays so whatever is asked of it.
///
/// The edges are level and upright in turns, so that the number of corners is even.
///
/// ```aidl
/// solid angle_iron { body = rectilinear_polygon((0, 0), (40, 0), (40, 5), (5, 5), (5, 30), (0, 30)) }
/// ```
fn rectilinear_polygon(points: list) =
    path([axis_step(points, i) for i in 0..<len(points) - 1] + [close()], from: points[0])

// The step from a corner to the next one. The last before the end goes as far as the start, so that the edge that
// closes the outline is level or upright, too.
fn axis_step(points: list, i: integer) = axis_move(
    points[i + 1] - points[i],
    written(points[i + 1] - points[i]),
    is_level: (abs(written(points[1].y - points[0].y)) < 0.000001) == (i % 2 == 0),
    is_last: i == len(points) - 2,
    is_even: len(points) % 2 == 0
)
fn axis_move(
    way: point, seen: point, is_level: bool, is_last: bool, is_even: bool
) = if not is_even or abs(if is_level then seen.y else seen.x) > 0.000001 then record(
    kind: "slanted", to: way, smooth: false
) else if is_last then record(
    kind: if is_level then "level_home" else "upright_home", smooth: false
) else if is_level then right(way.x) else up(way.y)
