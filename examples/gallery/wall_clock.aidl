/// A wall clock: a wooden case, a brass ring under glass, minute ticks, twelve numerals and three hands.
assembly wall_clock {
    param size = 240mm in 180..320
    param hour = 9 in 1..12 step 1
    param minute = 9 in 0..59 step 1
    param case = 0.13 in 0.08..0.18
    param numerals = 0.13 in 0.09..0.17

    let r = size / 2
    let wood = case * r
    let dial = r - wood
    let noon = 90deg
    let brass = "#dcb45c"

    for i in 0..3 {
        @color("black") @opacity(0.1) @stroke(none) @detached
        solid cast[i] { v = circle((0.05 * r, -0.06 * r), (0.97 + 0.02 * i) * r) }
    }
    @color(tint) @shade(light, way)
    solid band(tint = brass, outer = 10, inner = 5, light = "slope", way = -60deg) {
        v = ring(center: origin, outer_radius: outer, inner_radius: inner)
    }
    rim = band("#7a4a26", r, dial)
    moulding = band("#ab6c3a", r - 0.2 * wood, dial + 0.35 * wood)
    @color("#5d3519") @opacity(0.7) drawing grain { v = wood_grain(moulding.v, pitch: 0.6 * wood) }
    bezel = band(outer: dial + 0.05 * r, inner: dial)
    lip = band(darker(brass, 0.4), dial, dial - 0.03 * r, lighter(brass, 0.4))
    @color("#fffaf0") @shade("#e8dcc0", -60deg) solid face { v = circle(radius: dial - 0.03 * r) }
    track = band("#e3d6b6", 0.95 * dial, 0.88 * dial, "none")
    @color("#3a3128") @stroke(0.008 * r) drawing ticks {
        v = polar_array(line((0, 0), (0.05 * dial, 0)), n: 60, radius: 0.9 * dial)
    }
    @color("#3a3128") @stroke(none) solid hour_ticks {
        v = polar_array(strip((0, 0), (0.08 * dial, 0), 0.022 * r), n: 12, radius: 0.87 * dial)
    }
    @color("black") @opacity(0.2) @stroke(none) @detached
    solid shade { v = difference(face.v, copy(face.v, by: (0.04 * r, -0.04 * r))) }
    @color("#2b2a33") drawing numbers {
        for i in 1..12 {
            n[i] = text(str(i), center: polar(0.75 * dial, noon - 30deg * i), height: numerals * r)
        }
        brand = text("AIDL", center: (0, -0.5 * dial), height: 0.06 * r)
    }
    @color(brass) @shade(slope, -60deg) solid ornament {
        construction hollow = circle(center: origin, radius: 0.36 * dial)
        wreath = difference(rosette(outer_radius: 0.4 * dial, inner_radius: 0.38 * dial), hollow)
        flower = star(outer_radius: 0.3 * dial, inner_radius: 0.1 * dial, points: 8, angle: noon)
    }

    /// A leaf that points to an angle, with a counterweight behind the axle.
    solid hand(reach = 80mm, width = 8mm, tail = 20mm) {
        blade = rhombus(center: (0.55 * reach, 0), width: 0.9 * reach, height: width)
        bar = strip(start: (-tail, 0), end: (0.9 * reach, 0), width: 0.35 * width)
        counter = circle(center: (-tail, 0), radius: 0.5 * width)
        boss = circle(center: origin, radius: 0.75 * width)
    }
    let hours = noon - 30deg * (hour + minute / 60)
    let minutes = noon - 6deg * minute
    @color("black") @opacity(0.22) @stroke(none) assembly shadows at (0.02 * r, -0.025 * r) {
        short = hand(0.44 * dial, 0.07 * r, 0.1 * r) rotated hours
        long = hand(0.69 * dial, 0.055 * r, 0.14 * r) rotated minutes
    }
    @color("#2a3142") @shade(slope) assembly hands {
        short = hand(0.44 * dial, 0.07 * r, 0.1 * r) rotated hours
        long = hand(0.69 * dial, 0.055 * r, 0.14 * r) rotated minutes
    }
    @color("#c8312b") @shade(slope) solid second_hand rotated -105deg {
        needle = strip(start: (-0.22 * dial, 0), end: (0.88 * dial, 0), width: 0.014 * r)
        eye = ring(center: (-0.26 * dial, 0), outer_radius: 0.045 * r, inner_radius: 0.025 * r)
        boss = circle(center: origin, radius: 0.04 * r)
    }
    @color(brass) @shade(ball) solid cap { v = circle(radius: 0.025 * r) }
    @color("white") @opacity(0.22) @stroke(none) @clip(face.v) solid glare {
        v = [parallelogram((x * r, 0), w * r, 2 * r, 1.2 * r) for x, w in [
            [-0.05, 0.2], [0.14, 0.05]
        ]]
    }

    /// The loop that it hangs by, on a nail.
    hook = band(brass, 0.1 * r, 0.06 * r)
    @color("#7b828c") @shade(ball) solid nail { head = circle(radius: 0.035 * r) }

    constrain {
        concentric(moulding.v, bezel.v, lip.v, face.v, track.v, rim.v)
        cap.v.center == rim.v.center
        hook.v.center == rim.v.center + (0, 1.06 * r)
        nail.head.center == hook.v.center + (0, 0.025 * r)
    }
    assert numbers.inside(track.v.inner), "the numerals stay within the ticks"
}
