// Patterns that fill an outline and end on its border: copies of a cell (`tiled`).
// Each begins in the middle of the outline, courses of stones in its lower left corner.

/// Parallel lines over an outline, a `pitch` apart; bars if a `width` is given.
///
/// Lies at 45deg.
///
/// One line goes through the middle of the outline.
///
/// ```aidl
/// assembly section {
///     solid block { body = rectangle(width: 60, height: 40) }
///     drawing face { lines = hatching(block.body, pitch: 4, margin: 1) }
/// }
/// ```
fn hatching(of, pitch: length, angle: angle = 45deg, width: length = 0, margin: length = 0) = tiled(
    line(fixed((0, 0)), fixed((pitch, 0))),
    within: inset(of, margin),
    by: (pitch, 0),
    row: (0, pitch),
    angle: angle,
    start: center,
    width: width
)

/// Two sets of parallel lines over an outline, at right angles; bars if a `width` is given.
///
/// Lies at 45deg.
///
/// ```aidl
/// assembly handle {
///     solid grip { body = slot(start: (0, 0), end: (60, 0), width: 20) }
///     drawing wrap { lines = crosshatch(grip.body, pitch: 4) }
/// }
/// ```
fn crosshatch(
    of, pitch: length, angle: angle = 45deg, width: length = 0, margin: length = 0
) = tiled(
    [line(fixed((0, 0)), fixed((pitch, 0))), line(fixed((0, 0)), fixed((0, pitch)))],
    within: inset(of, margin),
    by: (pitch, 0),
    row: (0, pitch),
    angle: angle,
    start: center,
    width: width
)

/// A net of bars over an outline: the bars are `width` wide and a `pitch` apart.
///
/// ```aidl
/// solid sieve {
///     construction edge = circle(radius: 30)
///     rim = shell(edge, 3)
///     net = mesh(edge, pitch: 6, width: 1.5)
/// }
/// ```
fn mesh(of, pitch: length, width: length, angle: angle = 45deg, margin: length = 0) =
    crosshatch(of, pitch, angle: angle, width: width, margin: margin)

/// The crossed lines of a knurled grip; bars if a `width` is given. They lie `slope` to either side of `angle`.
///
/// ```aidl
/// assembly knob {
///     solid head { body = rectangle(width: 40, height: 16) }
///     drawing grip { lines = knurling(head.body, pitch: 2.5, margin: 1) }
/// }
/// ```
fn knurling(
    of,
    pitch: length,
    slope: angle = 30deg,
    angle: angle = 0deg,
    width: length = 0,
    margin: length = 0
) = diamonds(of, pitch / sin(2 * slope), slope, angle, width, margin)
fn diamonds(of, side: length, slope: angle, angle: angle, width: length, margin: length) = tiled(
    [
        line(fixed((0, 0)), fixed(polar(side, slope))),
        line(fixed((0, 0)), fixed(polar(side, -slope)))
    ],
    within: inset(of, margin),
    by: polar(side, slope),
    row: polar(side, -slope),
    angle: angle,
    start: center,
    width: width
)

/// The lines of a screw thread seen from the side, whose axis is upright at angle 0; bars if a `width` is given.
///
/// `pitch` is measured along the axis, and the lines rise by `slope` to the right. Lies with an upright axis.
///
/// ```aidl
/// assembly stud {
///     solid shank { body = rectangle(width: 12, height: 40) }
///     drawing thread { lines = threads(shank.body, pitch: 2.5) }
/// }
/// ```
fn threads(
    of,
    pitch: length,
    angle: angle = 0deg,
    slope: angle = 6deg,
    width: length = 0,
    margin: length = 0
) = hatching(of, pitch * cos(slope), angle: angle + slope, width: width, margin: margin)

/// Bars across an outline, half as wide as their `pitch` if no `width` is given. They run along `angle`, as the
/// lines of `hatching` do.
///
/// Lies upright.
///
/// ```aidl
/// solid vent {
///     body = rectangle(width: 60, height: 40)
///     hole slits { bars = ribs(body, pitch: 6, width: 2.5, margin: 5) }
/// }
/// ```
fn ribs(of, pitch: length, width: length = pitch / 2, angle: angle = 90deg, margin: length = 0) =
    hatching(of, pitch, angle: angle, width: width, margin: margin)

/// Slats that fill an outline from below: level bars at angle 0, each `width` wide, with a `gap` between them.
///
/// ```aidl
/// solid shutter {
///     construction opening = rectangle(width: 40, height: 50)
///     frame = shell(opening, 3)
///     leaves = slats(opening, width: 5, gap: 1.5)
/// }
/// ```
fn slats(of, width: length, gap: length, angle: angle = 0deg, margin: length = 0) = tiled(
    line(fixed((0, width / 2)), fixed((width, width / 2))),
    within: inset(of, margin),
    by: (width, 0),
    row: (0, width + gap),
    angle: angle,
    start: corner,
    width: width
)

/// Bricks in courses from the lower left of an outline: the joints as lines, or with a `mortar` the bricks.
///
/// Each course is moved by `shift` bricks against the one below. A brick measures `width` by `height` without mortar.
///
/// ```aidl
/// assembly house {
///     solid wall { body = rectangle(width: 60, height: 40) }
///     drawing courses { joints = bricks(wall.body, width: 10, height: 4) }
/// }
/// ```
fn bricks(
    of,
    width: length,
    height: length,
    mortar: length = 0,
    shift: number = 0.5,
    angle: angle = 0deg,
    margin: length = 0
) = courses(of, width, height, mortar, shift, angle, margin)

/// Tiles in rows from the lower left of an outline: the joints as lines, or with a `gap` the tiles.
///
/// ```aidl
/// solid mat {
///     construction edge = circle(radius: 30)
///     stones = tiles(edge, width: 8, gap: 1.5)
/// }
/// ```
fn tiles(
    of,
    width: length,
    height: length = width,
    gap: length = 0,
    angle: angle = 0deg,
    margin: length = 0
) = courses(of, width, height, gap, 0, angle, margin)

/// Boards with staggered ends, level at angle 0: the joints as lines, or with a `gap` the boards.
///
/// ```aidl
/// assembly shed {
///     solid door { body = rectangle(width: 40, height: 60) }
///     drawing boards { joints = planks(door.body, width: 5, length: 25, angle: 90deg) }
/// }
/// ```
fn planks(
    of,
    width: length,
    length: length = 6 * width,
    gap: length = 0,
    shift: number = 0.4,
    angle: angle = 0deg,
    margin: length = 0
) = courses(of, length, width, gap, shift, angle, margin)

// Rows of stones: the line below and the line to the left of each, or the stone.
fn courses(
    of, width: length, height: length, gap: length, shift: number, angle: angle, margin: length
) = tiled(
    if is_some(gap) then corners_of_box(width, height) else [
        line(fixed((0, 0)), fixed((width, 0))), line(fixed((0, 0)), fixed((0, height)))
    ],
    within: inset(of, margin),
    by: (width + gap, 0),
    row: (shift * (width + gap), height + gap),
    angle: angle,
    start: corner
)
fn corners_of_box(width: length, height: length) =
    polygon([fixed((0, 0)), fixed((width, 0)), fixed((width, height)), fixed((0, height))])

/// Squares of a chessboard over an outline, from its lower left: every other one.
///
/// ```aidl
/// assembly board {
///     @color("wheat") solid light { body = rectangle(width: 48, height: 48) }
///     @color("saddlebrown") solid dark { squares = checkers(light.body, size: 6) }
/// }
/// ```
fn checkers(of, size: length, angle: angle = 0deg, margin: length = 0) = tiled(
    corners_of_box(size, size),
    within: inset(of, margin),
    by: (size, size),
    row: (-size, size),
    angle: angle,
    start: corner
)

/// Dots over an outline, a `pitch` apart, every other row between those beside it unless `staggered: false`.
///
/// Only dots that lie wholly inside are made, unless `whole: false`.
///
/// ```aidl
/// solid speaker {
///     body = circle(radius: 30)
///     hole sound { openings = dots(body, pitch: 5, diameter: 3, margin: 2) }
/// }
/// ```
fn dots(
    of,
    pitch: length,
    diameter: length,
    staggered: bool = true,
    whole: bool = true,
    angle: angle = 0deg,
    margin: length = 0
) = tiled(
    circle(center: fixed((0, 0)), diameter: diameter),
    within: inset(of, margin),
    by: (pitch, 0),
    row: if staggered then polar(pitch, 60deg) else (0, pitch),
    angle: angle,
    start: center,
    whole: whole
)

/// Hexagons over an outline, `size` across their flats: their sides as lines, or with a `gap` the cells.
///
/// With `whole: true` only those are made that lie wholly inside.
///
/// ```aidl
/// solid panel {
///     body = rectangle(width: 60, height: 40)
///     hole cells { openings = honeycomb(body, size: 6, gap: 1.5, margin: 3, whole: true) }
/// }
/// ```
fn honeycomb(
    of, size: length, gap: length = 0, whole: bool = false, angle: angle = 0deg, margin: length = 0
) = tiled(
    if is_some(gap) then polygon(
        [polar(size / sqrt(3), 60deg * k + 30deg) for k in 0..5]
    ) else polyline([polar(size / sqrt(3), 60deg * k - 30deg) for k in 0..3]),
    within: inset(of, margin),
    by: (size + gap, 0),
    row: polar(size + gap, 60deg),
    angle: angle,
    start: center,
    whole: whole
)

/// The scales of a fish over an outline, round at the bottom: their edges as lines, or with a `gap` the scales.
///
/// ```aidl
/// assembly fish {
///     solid trunk { body = ellipse(rx: 30, ry: 16) }
///     drawing skin { edges = scales(trunk.body, width: 7) }
/// }
/// ```
fn scales(of, width: length, gap: length = 0, angle: angle = 0deg, margin: length = 0) = tiled(
    if is_some(gap) then offset(scale_outline(width / 2), -gap / 2) else scale_edge(width / 2),
    within: inset(of, margin),
    by: (width, 0),
    row: (width / 2, width / 2),
    angle: angle,
    start: center
)
fn scale_edge(r: length) =
    arc(center: fixed((0, 0)), radius: r, start_angle: 180deg, end_angle: 360deg)
fn scale_outline(r: length) = path(
    from: fixed((-r, 0)),
    arc_to(fixed((r, 0)), radius: r),
    arc_to(fixed((0, r)), radius: r, clockwise: true),
    arc_to(fixed((-r, 0)), radius: r, clockwise: true)
)

/// Rounded shingles in rows over an outline: their edges as lines, or with a `gap` the shingles.
///
/// ```aidl
/// assembly hut {
///     solid roof { body = trapezoid(bottom_width: 70, top_width: 40, height: 30) }
///     drawing cover { edges = shingles(roof.body, width: 8, height: 6) }
/// }
/// ```
fn shingles(
    of,
    width: length,
    height: length,
    round: length = width / 4,
    gap: length = 0,
    angle: angle = 0deg,
    margin: length = 0
) = tiled(
    if is_some(gap) then offset(
        if is_some(round) then shingle_outline(width / 2, height, round) else square_shingle(
            width / 2, height
        ),
        -gap / 2
    ) else shingle_edge(width / 2, height, round),
    within: inset(of, margin),
    by: (width, 0),
    row: (width / 2, height),
    angle: angle,
    start: corner
)
// By whether they are round.
fn shingles(
    of,
    width: length,
    height: length,
    round: bool,
    gap: length = 0,
    angle: angle = 0deg,
    margin: length = 0
) = shingles(
    of,
    width: width,
    height: height,
    round: if round then width / 4 else 0mm,
    gap: gap,
    angle: angle,
    margin: margin
)
// From the top of the left side around the bottom to where the next one has its left side.
fn shingle_edge(half: length, height: length, round: length) = path(
    from: fixed((-half, height)),
    if is_some(round) {
        line_to(fixed((-half, round))),
        arc_to(fixed((-half + round, 0)), radius: round),
        line_to(fixed((half - round, 0))),
        arc_to(fixed((half, round)), radius: round)
    } else {
        line_to(fixed((-half, 0))), line_to(fixed((half, 0))), line_to(fixed((half, height)))
    }
)
fn square_shingle(half: length, height: length) =
    polygon([fixed((-half, 0)), fixed((half, 0)), fixed((half, height)), fixed((-half, height))])
// What is seen of it below the round corners of the two above.
fn shingle_outline(half: length, height: length, round: length) = path(
    from: fixed((-half, height)),
    line_to(fixed((-half, round))),
    arc_to(fixed((-half + round, 0)), radius: round),
    line_to(fixed((half - round, 0))),
    arc_to(fixed((half, round)), radius: round),
    line_to(fixed((half, height))),
    line_to(fixed((round, height))),
    arc_to(fixed((0, height + round)), radius: round, clockwise: true),
    arc_to(fixed((-round, height)), radius: round, clockwise: true),
    close()
)

/// Lines like the grain of wood over an outline, about a `pitch` apart; bars if a `width` is given.
///
/// Lies level.
///
/// ```aidl
/// assembly desk {
///     solid leaf { body = rectangle(width: 80, height: 30) }
///     drawing veins { lines = wood_grain(leaf.body, pitch: 3) }
/// }
/// ```
fn wood_grain(
    of, pitch: length, angle: angle = 0deg, width: length = 0, margin: length = 0
) = tiled(
    [vein(k * pitch, height * pitch, 20 * pitch, crest) for k, height, crest in [
        [0, 0.7, 0.3], [1, 0.5, 0.4], [2, -0.3, 0.5], [3, -1, 0.65]
    ]],
    within: inset(of, margin),
    by: (20 * pitch, 0),
    row: (7 * pitch, 4 * pitch),
    angle: angle,
    start: corner,
    width: width
)

// A line that rises to a crest at a share of its length, and goes on level at both ends.
fn vein(y: length, height: length, length: length, crest: number) = path(
    from: fixed((0, y)),
    bezier_to(
        fixed((crest * length / 2, y)),
        fixed((crest * length / 2, y + height)),
        fixed((crest * length, y + height))
    ),
    bezier_to(
        fixed(((1 + crest) * length / 2, y + height)),
        fixed(((1 + crest) * length / 2, y)),
        fixed((length, y))
    )
)

/// Rays over an outline, `n` lines from a `center`, that of the outline if none is said; wedges if they get a `share`.
///
/// The first ray goes to `angle`. A wedge takes a `share` of the angle from ray to ray, on both sides of its ray.
///
/// ```aidl
/// assembly flag {
///     @color("gold") solid cloth { body = rectangle(width: 60, height: 40) }
///     @color("firebrick") solid sun { beams = rays(cloth.body, n: 16, share: 0.5) }
/// }
/// ```
fn rays(
    of,
    n: integer,
    center: point = of.center,
    share: number = 0,
    angle: angle = 0deg,
    margin: length = 0
) = if not 0 <= written(share) < 1 then refuse(
    "a ray takes a share of the angle to the next one, less than 1"
) else clip(
    ray_lines(center, norm((of.width, of.height)) + norm(of.center - center), n, share, angle),
    by: offset(of, -margin)
)
shape ray_lines(center: point, reach: length, n: integer, share: number, angle: angle) {
    assert n >= 1, "there is at least one ray"
    let pitch = 360deg / n
    for i in 0..<n {
        if written(share) > 0 {
            let edge = [center + polar(
                2 * reach, angle + pitch * (i + side * share / 2)
            ) for side in [-1, 1]]
            first[i] = line(center, edge[0])
            outer[i] = line(edge[0], edge[1])
            last[i] = line(edge[1], center)
        } else {
            ray[i] = line(center, center + polar(2 * reach, angle + pitch * i))
        }
    }
}

// The outline less a margin. What is written says whether there is one.
fn inset(of, margin: length) = if is_some(margin) then offset(of, -margin) else of
fn is_some(size: length) = written(size) > 0mm
