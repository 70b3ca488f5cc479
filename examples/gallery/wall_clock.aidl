/// A wall clock: a wooden case, a brass ring, minute ticks, twelve numerals and three hands.
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

    @color("black") @opacity(0.3) @stroke(none) @detached
    solid cast { v = circle((0.05 * r, -0.06 * r), r) }
    @color("#7a4a26") solid rim { v = ring(center: origin, outer_radius: r, inner_radius: dial) }
    @color("#a56a3a")
    solid moulding { v = ring(outer_radius: r - 0.2 * wood, inner_radius: dial + 0.35 * wood) }
    @color("#5d3519") drawing grain { v = wood_grain(moulding.v, pitch: 0.6 * wood) }
    @color("#d9b25f")
    solid bezel { v = ring(outer_radius: dial + 0.03 * r, inner_radius: dial - 0.02 * r) }
    @color("#fbf6e6") solid face { v = circle(radius: dial - 0.02 * r) }
    @color("#d8c9a6") solid track { v = ring(outer_radius: 0.96 * dial, inner_radius: 0.88 * dial) }
    @color("#3a3128") solid ticks {
        for i in 0..59 {
            let from = if i % 5 == 0 then 0.87 else 0.9
            let width = if i % 5 == 0 then 0.022 else 0.008
            mark[i] = strip(polar(from * dial, 6deg * i), polar(0.96 * dial, 6deg * i), width * r)
        }
    }
    @color("black") @opacity(0.2) @stroke(none) @detached
    solid shade { v = difference(face.v, copy(face.v, by: (0.04 * r, -0.04 * r))) }
    @color("#2b2a33") drawing numbers {
        for i in 1..12 {
            n[i] = text(str(i), center: polar(0.75 * dial, noon - 30deg * i), height: numerals * r)
        }
        brand = text("AIDL", center: (0, -0.5 * dial), height: 0.06 * r)
    }
    @color("#c9a45f") solid ornament {
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
    @color("#1f2430") assembly hands {
        let now = noon - 6deg * minute
        short = hand(
            reach: 0.44 * dial, width: 0.07 * r, tail: 0.1 * r
        ) rotated noon - 30deg * (hour + minute / 60)
        long = hand(reach: 0.64 * dial, width: 0.055 * r, tail: 0.14 * r) rotated now
    }
    @color("#c8312b") solid second_hand rotated -105deg {
        needle = strip(start: (-0.22 * dial, 0), end: (0.88 * dial, 0), width: 0.014 * r)
        eye = ring(center: (-0.26 * dial, 0), outer_radius: 0.045 * r, inner_radius: 0.025 * r)
        boss = circle(center: origin, radius: 0.04 * r)
    }
    @color("#e8c877") solid cap { v = circle(radius: 0.02 * r) }

    /// The loop that it hangs by, on a nail.
    @color("#d9b25f") solid hook { loop = ring(outer_radius: 0.1 * r, inner_radius: 0.06 * r) }
    @color("#555b66") solid nail { head = circle(radius: 0.035 * r) }

    constrain {
        concentric(moulding.v, bezel.v, face.v, track.v, rim.v)
        cap.v.center == rim.v.center
        hook.loop.center == rim.v.center + (0, 1.06 * r)
        nail.head.center == hook.loop.center + (0, 0.025 * r)
    }
    assert numbers.inside(track.v.inner), "the numerals stay within the ticks"
}
