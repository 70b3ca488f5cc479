// Wheels, and round rims with something all around: spokes, waves, teeth.

/// A wheel with spokes: a rim of a thickness (`rim`), a hub, and openings between the spokes; spoke 0 points to `angle`.
///
/// Its outlines are the circle `outer`, `opening[i]` after spoke `i`, and the circle `bore` where a `bore_radius` is said. An
/// opening has the arcs `outer` and `inner` and the lines `first` and `last`.
///
/// Lies with spoke 0 to the right.
///
/// ```aidl
/// solid cart_wheel { body = wheel(radius: 40, rim: 5, hub_radius: 9, spokes: 10, spoke_width: 3, bore_radius: 4) }
/// ```
shape wheel(
    center: point = (0, 0),
    radius: length,
    rim: length,
    hub_radius: length,
    spokes: integer = 8,
    spoke_width: length,
    bore_radius: length = 0,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert bore_radius < hub_radius, "the bore of a wheel is smaller than its hub"
    assert hub_radius < radius - rim,
        "between the hub and the rim of a wheel there is room for its spokes"
    assert spokes >= 2, "a wheel has at least two spokes"
    assert spoke_width < 2 * hub_radius * sin(180deg / spokes),
        "the spokes of a wheel leave room between them at its hub"
    outer = circle(center: center, radius: radius)
    if written(bore_radius) > 0 { bore = circle(center: center, radius: bore_radius) }
    for i in 0..<spokes {
        opening[i] = between_spokes(
            center: center,
            outer_radius: radius - rim,
            inner_radius: hub_radius,
            half: spoke_width / 2,
            start: angle + 360deg / spokes * i,
            end: angle + 360deg / spokes * (i + 1)
        )
    }
}

// What is open between two spokes of a width (2 `half`) that point to `start` and to `end`.
shape between_spokes(
    center: point,
    outer_radius: length,
    inner_radius: length,
    half: length,
    start: angle,
    end: angle
) {
    let wide = asin(half / outer_radius)
    let narrow = asin(half / inner_radius)
    outer = arc(
        center: center, radius: outer_radius, start_angle: start + wide, end_angle: end - wide
    )
    inner = arc(
        center: center, radius: inner_radius, start_angle: start + narrow, end_angle: end - narrow
    )
    first = line(inner.start, outer.start)
    last = line(outer.end, inner.end)
}

/// A round outline of `lobes` equal arcs that bulge outwards: a bottle cap, a flower, a pie crust, a cookie.
///
/// The arcs, `edge[i]`, reach out to `outer_radius` and meet at `inner_radius`; the first begins at `angle`. Where arcs
/// would run into each other, at a small `inner_radius`, they are pointed at their feet: petals, which are Béziers.
///
/// Lies with the start of an arc on the right.
///
/// ```aidl
/// solid cookie { body = rosette(outer_radius: 30, inner_radius: 27, lobes: 16) }
/// ```
shape rosette(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    lobes: integer = 12,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert lobes >= 3, "a rosette has at least three lobes"
    let half = 180deg / lobes
    assert inner_radius * cos(half) < outer_radius, "the lobes of a rosette bulge outwards"
    let chord = inner_radius * sin(half)
    let bulge = outer_radius - inner_radius * cos(half)
    let radius = (chord ^ 2 + bulge ^ 2) / (2 * bulge)
    let opening = atan2(chord, radius - bulge)
    let least = outer_radius * cos(half) / (1 + sin(half))
    let has_petals = written(inner_radius) < written(least)
    assert inner_radius > 0, "the lobes of a rosette meet outside of its center"
    assert has_petals or inner_radius >= least,
        "the lobes of this rosette run into each other: it needs fewer, or an `inner_radius` just above what is asked"
    for i in 0..<lobes {
        let way = angle + half * (2 * i + 1)
        if has_petals {
            let reach = (4 * outer_radius / cos(half) - inner_radius) / 3
            edge[i] = bezier(
                center + polar(inner_radius, way - half),
                center + polar(reach, way - half),
                center + polar(reach, way + half),
                center + polar(inner_radius, way + half)
            )
        } else {
            edge[i] = arc(
                center: center + polar(outer_radius - radius, way),
                radius: radius,
                start_angle: way - opening,
                end_angle: way + opening
            )
        }
    }
    let edges = edge
}

/// A round rim with `teeth` straight teeth: a knob, a crown, a castle nut, a cog in a drawing; gears that mesh are `gear`s.
///
/// A tooth takes a `share` of its pitch, 0.5 without it, and its sides point to the center; tooth 0 stands at `angle`. Its
/// edges are the arcs `tip[i]` and `root[i]` (after the tooth) and the lines `rise[i]` and `fall[i]`.
///
/// Lies with tooth 0 to the right.
///
/// ```aidl
/// solid knob {
///     body = cog(outer_radius: 25, inner_radius: 22, teeth: 18)
///     hole bore { rim = circle(center: origin, radius: 4) }
/// }
/// ```
shape cog(
    center: point = (0, 0),
    outer_radius: length,
    inner_radius: length,
    teeth: integer = 12,
    share = 0.5,
    angle: turn = 0deg,
    rotatable: bool = false
) {
    assert inner_radius < outer_radius, "the teeth of a cog stand out"
    assert teeth >= 2, "a cog has at least two teeth"
    assert 0 < share < 1, "a tooth takes a share of its pitch between 0 and 1"
    let pitch = 360deg / teeth
    let half = pitch * share / 2
    for i in 0..<teeth {
        let way = angle + pitch * i
        tip[i] = arc(
            center: center, radius: outer_radius, start_angle: way - half, end_angle: way + half
        )
        root[i] = arc(
            center: center,
            radius: inner_radius,
            start_angle: way + half,
            end_angle: way + pitch - half
        )
    }
    for i in 0..<teeth {
        rise[i] = line(root[(i + teeth - 1) % teeth].end, tip[i].start)
        fall[i] = line(tip[i].end, root[i].start)
    }
}

alias spoked_wheel = wheel
alias wheel_with_spokes = wheel
alias scalloped_circle = rosette
alias scalloped = rosette
alias scallops = rosette
alias bottle_cap = rosette
alias toothed_wheel = cog
alias toothed_rim = cog
alias cogwheel = cog
