// What runs from one thing to another: cords, springs and chains, to be drawn or made `thick`. They follow their ends,
// which may be points of other structures, and so they are of Béziers and lines alone, which hold no equations.

/// A cord that hangs from `start` to `end`: in the middle by `sag` below the straight way, a fifth of it if none is said.
///
/// `start` and `end` may be points of any structure above, which it follows. It is the Bézier `way`, a parabola.
///
/// With `sag: 0` it is straight, as a `wire` is.
///
/// ```aidl
/// assembly power_line {
///     solid left_pole { body = rectangle(bottom_center: (0, 0), width: 4, height: 50) }
///     solid right_pole { body = rectangle(bottom_center: (90, 0), width: 4, height: 40) }
///     @color("dimgray")
///     solid wire { v = thick(cord(left_pole.body.top_center, right_pole.body.top_center, sag: 12), 1.5) }
/// }
/// ```
shape cord(start: point, end: point, sag: length = norm(end - start) / 5) {
    let low = (start + end) / 2 - (0, 2 * sag)
    way = bezier(start, lerp(start, low, 2 / 3), lerp(end, low, 2 / 3), end)
}

// The way of a hose: a Bézier that keeps to its directions over about `reach`.
shape hose_way(
    start: point, end: point, leaving: angle, arriving: angle, reach: length = norm(end - start) / 2
) {
    way = bezier(start, start + polar(reach, leaving), end - polar(reach, arriving), end)
}

/// A smooth tube from `start` to `end`, `width` across: a hose, a pipe or a cable between two parts, which it follows.
///
/// `leaving` and `arriving` are directions of travel: one that goes out upwards and comes in from above has 90deg and
/// -90deg. It keeps to them over about `reach`, half of the straight way if none is said.
///
/// ```aidl
/// assembly pump {
///     solid tank { body = rectangle(center: (0, 0), width: 40, height: 30) }
///     solid motor { body = rectangle(center: (90, -5), width: 40, height: 20) }
///     @color("dimgray")
///     solid pipe { v = hose(tank.body.top_center, motor.body.top_center, 6, leaving: 90deg, arriving: -90deg) }
/// }
/// ```
fn hose(
    start: point,
    end: point,
    width: length,
    leaving: angle,
    arriving: angle = leaving,
    reach: length = norm(end - start) / 2
) = thick(hose_way(start, end, leaving, arriving, reach), width, caps: butt)

/// A coiled cord from `start` to `end`, as a telephone's: `turns` loops to the left of its way, `width` across in all.
///
/// It leaves and arrives straight on, over a share `lead` of its way at both ends. `start` and `end` may be points of any
/// structure above, which it follows. `segment[i]` are its Béziers, the leads and four for each loop.
///
/// The loops are on the left of its way.
///
/// ```aidl
/// assembly telephone {
///     solid base { body = dome(width: 40, height: 25) }
///     solid handset { body = rounded_rectangle(center: (100, 8), width: 12, height: 40, radius: 5) }
///     @color("dimgray")
///     solid wire { v = thick(coil(base.body.bottom_right + (0, 4), handset.body.left_center, width: 12), 2) }
/// }
/// ```
shape coil(start: point, end: point, width: length, turns: integer = 8, lead: number = 0.1) {
    assert turns >= 1, "a coil has at least one loop"
    assert 0 < lead < 0.5, "the leads of a coil are a share of its way, between 0 and 0.5"
    let pitch = (end - start) * ((1 - 2 * lead) / turns)
    let up = turned(unit(end - start), 90deg) * (width / 2mm)
    fn quarter(x, y, i) = lerp(start, end, lead) + pitch * (i / 4 + loop_reach * x) + up * y
    fn place(i) = quarter([0, 1, 0, -1][i % 4], [-1, 0, 1, 0][i % 4], i)
    fn way(i) = pitch * (1 / 12 + loop_handle * loop_reach * [
        1, 0, -1, 0
    ][i % 4]) + up * (loop_handle * [0, 1, 0, -1][i % 4])
    let quarters = 4 * turns
    let last = quarters + 1
    for i in 0..quarters { knot[i] = place(i) }
    segment[0] = bezier(
        start, start + (end - start) * (lead / 2), knot[0] - (end - start) * (lead / 2), knot[0]
    )
    for i in 0..<quarters {
        segment[i + 1] = bezier(knot[i], knot[i] + way(i), knot[i + 1] - way(i + 1), knot[i + 1])
    }
    segment[last] = bezier(
        knot[quarters],
        knot[quarters] + (end - start) * (lead / 2),
        end - (end - start) * (lead / 2),
        end
    )
}

// How far a loop goes back and forth, in pitches, and the handle of a quarter of a circle about 1.
let loop_reach = 0.6
let loop_handle = 0.5523

/// A spring from `start` to `end`, seen from the side: `turns` to either side, `width` across, round at its turns.
///
/// It leaves and arrives straight, over a share `lead` of its way at both ends; with `round: false` its turns are
/// sharp. `start` and `end` may be points of any structure above, which it follows. `segment[i]` are its pieces in order.
///
/// The first half is on the left of its way.
///
/// ```aidl
/// assembly scale {
///     solid ceiling { body = rectangle(width: 50, height: 6) }
///     solid bob { body = trapezoid(center: (0, -60), bottom_width: 30, top_width: 20, height: 20) }
///     @color("dimgray")
///     solid coils { v = thick(spring(ceiling.body.bottom_center, bob.body.top_center, width: 14), 1.6) }
/// }
/// ```
shape spring(
    start: point,
    end: point,
    width: length,
    turns: integer = 6,
    lead: number = 0.1,
    round: bool = true
) {
    assert turns >= 1, "a spring has at least one turn"
    assert 0 < lead < 0.5, "the leads of a spring are a share of its way, between 0 and 0.5"
    let halves = 2 * turns
    let half = (end - start) * ((1 - 2 * lead) / halves)
    let up = turned(unit(end - start), 90deg) * (width / 2mm)
    knot[0] = lerp(start, end, lead)
    for i in 0..<halves {
        knot[i + 1] = knot[0] + half * (i + 0.5) + up * (if i % 2 == 0 then 1 else -1)
    }
    knot[halves + 1] = lerp(end, start, lead)
    segment[0] = line(start, knot[0])
    for i in 0..halves {
        let is_first = i == 0
        let is_last = i == halves
        if round {
            segment[i + 1] = bezier(
                knot[i],
                knot[i] + half * (if is_first then 0.25 else 0.5),
                knot[i + 1] - half * (if is_last then 0.25 else 0.5),
                knot[i + 1]
            )
        } else {
            segment[i + 1] = line(knot[i], knot[i + 1])
        }
    }
    segment[halves + 2] = line(knot[halves + 1], end)
}

/// A chain from `start` to `end`, as strokes to be made `thick`: links seen flat and from their edge in turns.
///
/// A link seen flat, the first and every other one, is `width` across, half as wide as long if none is said.
/// `start` and `end` may be points of any structure above, which it follows. `link[i]` are its links.
///
/// ```aidl
/// assembly swing {
///     solid branch { body = rectangle(width: 60, height: 6) }
///     solid seat { body = rounded_rectangle(center: (0, -70), width: 40, height: 5, radius: 2) }
///     @color("dimgray")
///     solid chains {
///         left = thick(chain(branch.body.bottom_center - (15, 0), seat.body.top_center - (15, 0)), 1.2)
///         right = thick(chain(branch.body.bottom_center + (15, 0), seat.body.top_center + (15, 0)), 1.2)
///     }
/// }
/// ```
shape chain(
    start: point,
    end: point,
    links: integer = 9,
    width: length = norm(end - start) / max(1, links) / 2
) {
    assert links >= 1, "a chain has at least one link"
    let up = turned(unit(end - start), 90deg) * (width / 2mm)
    for i in 0..<links {
        let from = lerp(start, end, i / links)
        let to = lerp(start, end, (i + 1) / links)
        if i % 2 == 0 { link[i] = flat_link(from, to, up) } else { link[i] = line(from, to) }
    }
}

// A link between two joints: four quarters that are fuller than an ellipse's. `up` goes to its left side.
shape flat_link(start: point, end: point, up: point) {
    let middle = (start + end) / 2
    let half = (end - start) / 2
    left = bezier(start, start + up * 0.8, middle + up - half * 0.6, middle + up)
    left_end = bezier(middle + up, middle + up + half * 0.6, end + up * 0.8, end)
    right_end = bezier(end, end - up * 0.8, middle - up + half * 0.6, middle - up)
    right = bezier(middle - up, middle - up - half * 0.6, start - up * 0.8, start)
}

alias telephone_cord = coil
alias coiled_cord = coil
alias coil_spring = spring
alias cable = cord
alias hanging_cord = cord
