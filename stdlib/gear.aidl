// Spur gears and what they run on. A tooth is computed once, for a module of 1 mm and with constants only; a gear
// turns and scales it, so that its unknowns are few however many teeth it has.

/// A spur gear, a wheel with involute teeth: tooth 0 points to `angle`, the others follow counter-clockwise.
///
/// `clearance`, `profile_shift` and `addendum` are in modules; `backlash` is what each tooth is thinner than half the
/// pitch. It has `pitch_radius`, `pitch_diameter`, `base_radius`, `outer_radius`, `root_radius`, `tooth[i]` (each with
/// a `tip`, `right_flank` and `left_flank`) and `root[i]`, the arc after `tooth[i]`. Below the base circle the flanks
/// go on as radial lines; a cutter would undercut a gear of fewer than `min_teeth` teeth.
///
/// Lies with tooth 0 to the right.
///
/// ```aidl
/// solid wheel {
///     body = gear(teeth: 20, module: 2, center: origin)
///     hole bore { rim = circle(center: origin, diameter: 8) }
/// }
/// ```
shape gear(
    teeth: integer,
    module: length,
    pressure_angle = 20deg,
    center: point = (0, 0),
    angle: turn = 0deg,
    backlash: length = 0,
    clearance = 0.25,
    profile_shift = 0,
    addendum = 1,
    rotatable: bool = false
) {
    assert teeth >= 3 and written(module) > 0,
        "a gear has at least 3 teeth and a module of more than 0"
    if pressure_angle < 5deg or pressure_angle > 40deg {
        assert false, "the pressure angle of a gear is from 5deg to 40deg; 20deg is customary"
    }
    if not (clearance >= 0 and addendum >= 0 and abs(profile_shift) <= 1) {
        assert false,
            "in modules, a gear has a clearance and an addendum of 0 or more and a profile shift of -1 to 1"
    }

    // Of a gear of module 1 mm: its radii, and its flank from where it leaves the root circle to the tip.
    let slope = tan(written(pressure_angle))
    let pitch = teeth * 0.5mm
    let base = pitch * cos(written(pressure_angle))
    let outer = pitch + 1mm * written(addendum + profile_shift)
    let inner = pitch + 1mm * written(profile_shift - 1 - clearance)
    assert inner > 0, "the teeth of this gear are deeper than its radius: it needs more of them"
    assert outer > base, "the teeth of this gear end below its base circle, where no involute is"
    let foot = roll_at(max(inner, base), base)
    let top = roll_at(outer, base)
    let flank = involute(base, foot, top)
    let side = [flank[i] for i in (if inner < base then 0 else 1)..5]

    // Half of a tooth, seen from the centre: at the base circle, at the root and at the tip.
    let thinner = from_radians(backlash / pitch_diameter)
    let half = (90deg + from_radians(2 * written(profile_shift) * slope)) / teeth + swing(
        from_radians(slope)
    )
    let half_root = half - swing(foot) - thinner
    let half_tip = half - swing(top) - thinner
    assert half_root < 180deg / teeth, "the teeth of this gear run into each other at their roots"
    assert half_tip > 0deg, "the teeth of this gear run out into points below their height"

    let pitch_diameter = teeth * module
    let pitch_radius = pitch_diameter / 2
    let base_radius = module / 1mm * base
    let outer_radius = module / 1mm * outer
    let root_radius = module / 1mm * inner
    let min_teeth = ceil(2 * (1 - profile_shift) / square(sin(written(pressure_angle))))

    for i in 0..<teeth {
        let gap = angle + 360deg / teeth * (i + 0.5)
        let reach = 180deg / teeth - half_root
        root[i] = arc(
            center: center, radius: root_radius, start_angle: gap - reach, end_angle: gap + reach
        )
    }
    for i in 0..<teeth {
        let way = angle + 360deg / teeth * i
        let right_axis = polar(module, way - half + thinner)
        let left_axis = polar(module, way + half - thinner)
        tooth[i] = gear_tooth(
            [root[(i + teeth - 1) % teeth].end] + [center + placed(
                p.x, p.y, right_axis
            ) for p in side],
            [root[i].start] + [center + placed(p.x, -p.y, left_axis) for p in side],
            center,
            radius: outer_radius,
            first: way - half_tip,
            last: way + half_tip
        )
    }
}

/// By the pitch diameter in place of the module.
fn gear(
    teeth: integer,
    pitch_diameter: length,
    pressure_angle = 20deg,
    center: point = (0, 0),
    angle: angle = 0deg,
    backlash: length = 0
) = gear(
    teeth: teeth,
    module: pitch_diameter / teeth,
    pressure_angle: pressure_angle,
    center: center,
    angle: angle,
    backlash: backlash
)

// One tooth: an arc for its tip, and sides through points from the root up; a straight foot comes before the flank.
shape gear_tooth(
    right: list, left: list, center: point, radius: length, first: angle, last: angle
) {
    tip = arc(center: center, radius: radius, start_angle: first, end_angle: last)
    let foot = len(right) % 3
    if foot == 1 {
        right_foot = line(right[0], right[1])
        left_foot = line(left[1], left[0])
    }
    let up = right + [tip.start]
    let down = left + [tip.end]
    for k in 0..<len(right) / 3 - foot / 3 {
        let i = foot + 3 * k
        right_flank[k] = bezier(up[i], up[i + 1], up[i + 2], up[i + 3])
        left_flank[k] = bezier(down[i + 3], down[i + 2], down[i + 1], down[i])
    }
}

// The vector with these coordinates along an axis, which is as long as 1 mm of them, and across it.
fn placed(x: length, y: length, axis: point) =
    ((axis.x * x - axis.y * y) / 1mm, (axis.y * x + axis.x * y) / 1mm)

// --- The involute of a circle --------------------------------------------------------------------
// What a taut thread draws that is unwound from a circle. `roll` is the angle that has been unwound: the point is
// then roll * base away from where the thread leaves the circle, and the curve runs in the direction `roll`.

fn from_radians(radians: number) = radians * 180deg / pi
fn unwound(base: length, roll: angle) =
    polar(base, roll) + polar(base * radians(roll), roll - 90deg)
fn roll_at(radius: length, base: length) = from_radians(sqrt(square(radius / base) - 1))

// The direction in which a point of the involute is seen from the centre.
fn swing(roll: angle) = roll - atan(radians(roll))

// The involute between two rolls as two Béziers, seven points. Their handles have its directions, and such lengths
// that they meet the involute once more between; at 53 % of the roll the error is least: 1/10000 of a module.
fn involute(base: length, first: angle, last: angle) = [unwound(base, first)] + involute_piece(
    base, first, (first + last) / 2
) + involute_piece(base, (first + last) / 2, last)
fn involute_piece(base: length, first: angle, last: angle) = involute_between(
    unwound(base, first),
    unwound(base, last),
    unwound(base, first + 0.53 * (last - first)),
    polar(1mm, first),
    polar(1mm, last)
)

// A Bézier without its first point: from start in direction `out` to end in direction `on`, its middle at a point.
fn involute_between(start: point, end: point, middle: point, out: point, on: point) =
    involute_handles(start, end, (middle - (start + end) / 2) * (8 / 3), out, on)
fn involute_handles(start: point, end: point, bulge: point, out: point, on: point) = [
    start + out * (cross(bulge, on) / cross(out, on)),
    end - on * (cross(bulge, out) / cross(out, on)),
    end
]

// --- What gears run with -------------------------------------------------------------------------

/// A ring gear, with its teeth inside: tooth 0 points from `angle` to the centre.
///
/// `space` is the outline of the toothless part, itself a gear: `space.tooth[i]` follows tooth i.
///
/// ```aidl
/// solid ring_gear {
///     body = internal_gear(teeth: 36, module: 2, outer_radius: 44)
/// }
/// ```
shape internal_gear(
    teeth: integer,
    module: length,
    outer_radius: length,
    pressure_angle = 20deg,
    center: point = (0, 0),
    angle: turn = 0deg,
    backlash: length = 0,
    clearance = 0.25,
    rotatable: bool = false
) {
    rim = circle(center: center, radius: outer_radius)
    space = gear(
        teeth: teeth,
        module: module,
        pressure_angle: written(pressure_angle),
        center: center,
        angle: angle + 180deg / teeth,
        backlash: -backlash,
        addendum: 1 + written(clearance),
        clearance: 0
    )
    let pitch_diameter = teeth * module
    let pitch_radius = pitch_diameter / 2
    let inner_radius = space.root_radius
    assert outer_radius > space.outer_radius,
        "the ring is not larger than the spaces between its teeth"
}

/// A toothed bar: `center` is the middle of its pitch line, along which the teeth stand `pi * module` apart.
///
/// `height` is the material below the teeth; `tooth[i]` has a `tip` and two flanks, from left to right.
///
/// Lies teeth up; `center` is on the pitch line.
///
/// ```aidl
/// solid bar { body = rack(teeth: 8, module: 2, height: 5) }
/// ```
shape rack(
    teeth: integer,
    module: length,
    height: length,
    pressure_angle = 20deg,
    center: point = (0, 0),
    angle: turn = 0deg,
    clearance = 0.25,
    rotatable: bool = false
) {
    assert teeth >= 1, "a rack has at least one tooth"
    if pressure_angle < 5deg or pressure_angle > 30deg {
        assert false, "the pressure angle of a rack is from 5deg to 30deg; 20deg is customary"
    }
    let axis = polar(module, angle)
    let slope = tan(written(pressure_angle)) * 1mm
    let pitch = pi * 1mm
    let depth = 1mm * (1 + written(clearance))
    let narrow = pitch / 4 - slope
    let wide = pitch / 4 + slope * (1 + written(clearance))
    let length = teeth * pi * module
    for i in 0..<teeth {
        let x = pitch * (i - (teeth - 1) / 2)
        let corners = [(x - wide, -depth), (x - narrow, 1mm), (x + narrow, 1mm), (x + wide, -depth)]
        tooth[i] = polyline([center + placed(p.x, p.y, axis) for p in corners])
    }
    for i in 0..<teeth - 1 { root[i] = line(tooth[i].end, tooth[i + 1].start) }
    let half = pitch * teeth / 2
    let down = polar(height, angle - 90deg)
    let first = center + placed(-half, -depth, axis)
    let last = center + placed(half, -depth, axis)
    back = polyline([tooth[-1].end, last, last + down, first + down, first, tooth[0].start])
    construction pitch_line = line(center + placed(-half, 0, axis), center + placed(half, 0, axis))
}

/// The gears run together: they stand the sum of their pitch radii apart, and a tooth of one meets a gap of the other.
///
/// `backlash` moves the centres further apart; gears with a backlash do not touch, which `@detached` allows. Gears that
/// mesh have one module and one pressure angle; profile shifts that do not cancel move them apart. A gear meshes with a
/// rack from above, with an internal gear from inside.
///
/// ```aidl
/// assembly drive {
///     solid pinion { body = gear(teeth: 12, module: 2, center: origin) }
///     solid wheel  { body = gear(teeth: 24, module: 2, center: (30, 20)) }
///     constrain meshes(wheel.body, pinion.body)
/// }
/// ```
constraint meshes(a: gear, b: gear, backlash: length = 0) {
    let shift = 2 * (a.profile_shift + b.profile_shift) / (a.teeth + b.teeth)
    distance(a.center, b.center) == spread_by_shift(
        written(shift), written(b.pressure_angle)
    ) * (a.pitch_radius + b.pitch_radius) + backlash
    a.module == b.module
    a.pressure_angle == b.pressure_angle
    let from_a = (heading(b.center - a.center) - a.angle) * a.teeth
    let from_b = (heading(a.center - b.center) - b.angle) * b.teeth
    from_a + from_b == nearest_turn(from_a + from_b)
}
constraint meshes(a: gear, b: internal_gear, backlash: length = 0) {
    distance(a.center, b.center) == b.pitch_radius - a.pitch_radius - backlash
    a.module == b.module
    a.pressure_angle == b.pressure_angle
    let outward = heading(a.center - b.center)
    let between = (outward - a.angle) * a.teeth - (outward - b.angle) * b.teeth
    between == nearest_turn(between)
}
constraint meshes(a: internal_gear, b: gear, backlash: length = 0) {
    meshes(b, a, backlash: backlash)
}
constraint meshes(a: gear, b: rack, backlash: length = 0) {
    offset_from(a.center, b.pitch_line) == a.pitch_radius + backlash
    a.module == b.module
    a.pressure_angle == b.pressure_angle
    (a.angle - b.pitch_line.angle + 90deg) * a.teeth + 360deg * dot(
        a.center - b.center, direction(b.pitch_line)
    ) / (pi * a.module * 1mm) == 180deg * b.teeth
}
constraint meshes(a: rack, b: gear, backlash: length = 0) { meshes(b, a, backlash: backlash) }

// The direction of a way, counted on from the side to which it is written, so that it does not jump there.
fn heading(v: point) = if written(v.x) >= 0mm then atan2(v.y, v.x) else atan2(-v.y, -v.x) + 180deg

// The phase between two gears at which a tooth meets a gap, of all these the nearest to the one that is written.
fn nearest_turn(phase: angle) = 180deg + 360deg * round((written(phase) - 180deg) / 360deg)

// By how much profile shifts spread two gears: cosines of the pressure angle and of the working one, whose involute
// (the tangent without the angle) is larger by shift * tan(pressure angle). Newton's steps find it.
fn spread_by_shift(shift: number, pressure: angle) =
    cos(pressure) / cos(working_angle(pressure, tan(pressure) * (1 + shift) - radians(pressure), 8))
fn working_angle(
    near: angle, involute: number, steps: integer
) = if steps == 0 then near else working_angle(
    near - from_radians((tan(near) - radians(near) - involute) / square(tan(near))),
    involute,
    steps - 1
)

/// The `angle` at which a gear meshes with another that lies in a direction and has its tooth 0 at `other_angle`.
///
/// ```aidl
/// assembly pair {
///     solid pinion { body = gear(teeth: 12, module: 2, center: origin) }
///     solid wheel {
///         body = gear(teeth: 20, module: 2, center: (32, 0), angle: mesh_angle(20, 12, direction: 180deg))
///     }
/// }
/// ```
fn mesh_angle(
    teeth: integer, other_teeth: integer, direction: angle = 180deg, other_angle: angle = 0deg
) = direction + (180deg + (direction + 180deg - other_angle) * other_teeth) / teeth

alias spur_gear = gear
alias ring_gear = internal_gear
alias mesh = meshes
