// Bolts, screws, nuts and washers as they are seen from the side, by the sizes of `screw`. What is on them (the edges of
// a hexagon, a thread) is strokes of a drawing on their material. All is exact in their own frame, which stands anywhere.

/// A metric bolt or screw seen from the side, upright with its head on top; `head`: hex, socket, pan or countersunk.
///
/// Stands with its `origin` at `seat`, the middle of what its head lies on, and `length` below it its `tip`; a countersunk
/// one is held at the middle of its top, flush, and `length` is all of it. `crown` is the middle of the top. `thread` is
/// `lines`, strokes on a straight `shank`; `teeth`, a toothed outline; or `none`. It is `thread_length` long from the tip, as
/// in the standard unless said: ISO 4014, 4762, 7045 or 10642.
///
/// ```aidl
/// assembly joint {
///     @color("peru") solid upper { body = rectangle(width: 50, height: 10) }
///     @color("tan") solid lower { body = rectangle(width: 50, height: 12) }
///     @color("silver") left = bolt("m6", length: 30)
///     @color("silver") right = bolt("m6", length: 20, head: "countersunk", thread: "teeth")
///     @color("silver") low_nut = nut("m6")
///     constrain {
///         upper.on_top_of(lower, align: center)
///         left.seat == upper.body.top_left + (13, 0)
///         right.seat == upper.body.top_right - (13, 0)
///         low_nut.crown == lower.body.bottom_left + (13, 0)
///     }
/// }
/// ```
solid bolt(
    size,
    length: length,
    head: text = "hex",
    thread: text = "lines",
    thread_length: length = standard_thread(metric(size), choice(head, head_kinds), length)
) {
    let s = metric(size)
    let kind = choice(head, head_kinds)
    let cut = choice(thread, ["lines", "teeth", "none"])
    let r = s.diameter / 2
    let depth = thread_depth * s.pitch
    let top = head_height(s, kind)
    let sunk = if kind == "countersunk" then sunk_height(s) else 0mm
    let begin = max(sunk + s.pitch / 2, length - thread_length)
    let turns = if cut != "none" then max(
        0, floor(written((length - depth - begin) / s.pitch))
    ) else 0
    assert thread_length >= 0, "a thread is not shorter than nothing"
    assert length > sunk + depth, "a screw is longer than its chamfered tip and a sunk head"

    seat = point(fixed((0, 0)))
    tip = point(fixed((0, -length)))
    crown = point(fixed((0, top)))
    if kind == "hex" {
        cap = polygon(hex_corners(s.nut, top, false))
    } else if kind == "socket" {
        cap = polygon(
            mirrored_corners(
                [(s.head / 2, 0), (s.head / 2, top - r / 5), (s.head / 2 - r / 5, top)]
            )
        )
    } else if kind == "pan" and s.pan > 0mm {
        cap = pan_head(s.pan / 2, s.pan_height, s.pan_crown)
    } else {
        cap = polygon(mirrored_corners([(r, -sunk), (s.countersink / 2, 0)]))
    }
    fn flank(begin, turns) = [(r, -sunk)] + (if cut == "teeth" then teeth(
        r, depth, begin, s.pitch, turns
    ) else []) + [(r, depth - length), (r - depth, -length)]
    shank = polygon(
        [fixed(p) for p in flank(begin, turns)] + flipped(flank(begin + s.pitch / 2, turns - 1))
    )
    drawing detail at fixed((0, 0)) {
        neck = line(fixed((-r, -sunk)), fixed((r, -sunk)))
        if kind == "hex" { faces = hex_faces(s.nut, top, false) }
        if kind == "socket" {
            for i in 1..11 {
                let x = s.head / 2 * cos(15deg * i)
                grip[i] = line(fixed((x, top / 8)), fixed((x, top - r / 5)))
            }
        }
        for i in 0..<turns {
            let y = -begin - i * s.pitch
            turn[i] = line(fixed((-r, y - s.pitch / 2)), fixed((r, y)))
        }
    }
}

// A screw by its name, its record, or its diameter alone, which for a hole would be that of the hole.
fn metric(size) = screw(size)
fn metric(size: length) = screw("m" + str(written(size / 1mm)))

// The depth of an external thread in pitches, ISO 68-1: 17/24 of the height of its triangle.
let thread_depth = 17 / 24 * cos(30deg)

let head_kinds = ["hex", "socket", "pan", "countersunk"]

fn head_height(
    s: record, kind: text
) = if kind == "hex" then s.bolt_head else if kind == "socket" then s.diameter else if kind == "pan" then pan_height(
    s
) else 0mm
fn pan_height(s: record) = if s.pan > 0mm then s.pan_height else refuse(
    "pan heads end at M10, in ISO 7045: this one may be hex, socket or countersunk"
)
// Sunk heads have a right angle.
fn sunk_height(s: record) = (s.countersink - s.diameter) / 2

// The length of thread that a standard asks for, on a screw that is long enough for it.
fn standard_thread(
    s: record, kind: text, length: length
) = if kind == "pan" then if s.diameter > 3mm then 38mm else 25mm else if kind != "hex" then 2 * s.diameter + 12mm else 2 * s.diameter + (if written(
    length
) > 200mm then 25mm else if written(length) > 125mm then 12mm else 6mm)

// The other half of an outline whose right half is known, from the last corner back to the first.
fn flipped(corners) = [fixed((-p.x, p.y)) for p in reversed(corners)]
fn mirrored_corners(corners) = [fixed(p) for p in corners] + flipped(corners)

// Crests and roots in turns down the right side of a thread: `begin` is the depth of the first crest.
fn teeth(r: length, depth: length, begin: length, pitch: length, turns: integer) =
    [(if j % 2 == 0 then r else r - depth, -begin - j * pitch / 2) for j in 0..2 * turns]

// A hexagon seen across its corners, chamfered at 30 degrees on top, or at both ends, to a circle as wide as its flats.
fn hex_corners(flats: length, height: length, both: bool) = mirrored_corners(
    (if both then [(flats / 2, 0), (hex_half(flats), hex_drop(flats))] else [
        (hex_half(flats), 0)
    ]) + [(hex_half(flats), height - hex_drop(flats)), (flats / 2, height)]
)
fn hex_half(flats: length) = flats / 2 / cos(30deg)
fn hex_drop(flats: length) = (hex_half(flats) - flats / 2) * tan(30deg)

// The edges between its three faces, and where the chamfer meets these.
shape hex_faces(flats: length, height: length, both: bool) {
    let half = hex_half(flats)
    let drop = hex_drop(flats)
    let low = if both then drop else 0mm
    for i, x in enumerate([-half / 2, half / 2]) {
        edge[i] = line(fixed((x, low)), fixed((x, height - drop)))
    }
    for i in 0..2 {
        let ends = [[-1, -0.75, -0.5], [-0.5, 0, 0.5], [0.5, 0.75, 1]][i]
        over[i] = rounded_end(half, ends, height - drop, height)
        if both { under[i] = rounded_end(half, ends, drop, 0mm) }
    }
}
fn rounded_end(half: length, ends, low: length, high: length) = arc(
    start: fixed((half * ends[0], low)),
    end: fixed((half * ends[2], low)),
    mid: fixed((half * ends[1], high))
)

// A head with straight sides and a crown of a radius.
fn pan_head(half: length, height: length, crown: length) = path(
    from: fixed((-half, 0)),
    line_to(fixed((half, 0))),
    line_to(fixed((half, height - crown + sqrt(crown ^ 2 - half ^ 2)))),
    arc_to(fixed((-half, height - crown + sqrt(crown ^ 2 - half ^ 2))), radius: crown),
    close()
)

/// A cap screw with a socket in its knurled head (ISO 4762), seen from the side: a `bolt` with `head: "socket"`.
///
/// Stands with its `origin` at the middle of what its head lies on. Its parts are those of a `bolt`.
///
/// ```aidl
/// assembly clamp {
///     @color("tan") solid jaw { body = rectangle(width: 30, height: 16) }
///     @color("dimgray") fixing = cap_screw("m5", length: 25)
///     constrain fixing.seat == jaw.body.top_center
/// }
/// ```
solid cap_screw(size, length: length, thread: text = "lines") {
    part = bolt(size, length, head: "socket", thread: thread) at fixed((0, 0))
    let seat = part.seat
    let tip = part.tip
    let crown = part.crown
}

/// A machine screw seen from the side, with a pan head (ISO 7045) unless `head` is countersunk or another of a `bolt`.
///
/// Stands with its `origin` at the middle of what its head lies on, a countersunk one at the middle of its top. Its parts are
/// those of a `bolt`.
///
/// ```aidl
/// assembly hinge {
///     @color("gold") solid leaf { body = rectangle(width: 40, height: 3) }
///     for i in 0..1 {
///         @color("silver") fixing[i] = machine_screw("m4", length: 16)
///         constrain fixing[i].seat == leaf.body.top_center + (20 * i - 10, 0)
///     }
/// }
/// ```
solid machine_screw(size, length: length, head: text = "pan", thread: text = "lines") {
    part = bolt(size, length, head: head, thread: thread) at fixed((0, 0))
    let seat = part.seat
    let tip = part.tip
    let crown = part.crown
}

/// A wood screw with a countersunk head and a pointed tip, seen from the side; by the diameter of its shank.
///
/// Stands with its `origin` at `seat`, the middle of the top of its head, twice as wide as the shank; `tip` is `length` below.
/// 0.6 of it is thread, to the point, as in DIN 97.
///
/// ```aidl
/// assembly shelf {
///     @color("peru") solid board { body = rectangle(width: 60, height: 14) }
///     @color("burlywood") solid side { body = rectangle(width: 16, height: 40) }
///     @color("gold") fixing = wood_screw(diameter: 5, length: 40)
///     constrain {
///         board.on_top_of(side, align: center)
///         fixing.seat == board.body.top_center
///     }
/// }
/// ```
solid wood_screw(diameter: length, length: length) {
    let r = diameter / 2
    let core = 0.7 * r
    let pitch = 0.45 * diameter
    let begin = 0.4 * length
    let taper = length - 1.8 * diameter
    let turns = if written(diameter) > 0mm then max(
        1, floor(written((length - diameter / 2 - begin) / pitch))
    ) else 1
    assert 0 < diameter < length / 3, "a wood screw is longer than three times its diameter"
    // How much is left of a radius at a depth: the tip is a cone.
    fn left_of(radius, depth) = radius * min(1, max(0, (length - depth) / (length - taper)))
    fn flank(shift, turns) = [(2 * r, 0), (r, -r), (r, -begin)] + [(left_of(
        if j % 2 == 0 then core else r, begin + shift + j * pitch / 2
    ), -begin - shift - j * pitch / 2) for j in 0..2 * turns]
    seat = point(fixed((0, 0)))
    tip = point(fixed((0, -length)))
    body = polygon(
        [fixed(p) for p in flank(pitch / 4, turns)] + [fixed((0, -length))] + flipped(
            flank(pitch * 3 / 4, turns - 1)
        )
    )
    drawing detail at fixed((0, 0)) {
        neck = line(fixed((-r, -r)), fixed((r, -r)))
        for i in 0..<turns - 1 {
            let y = begin + pitch * (i + 0.75)
            turn[i] = line(
                fixed((-left_of(r, y + pitch / 2), -y - pitch / 2)), fixed((left_of(r, y), -y))
            )
        }
    }
}

/// A hexagon nut seen from the side (ISO 4032), chamfered on both sides.
///
/// Stands with its `origin` at `seat`, the middle of its lower face; `crown` is that of its upper one.
///
/// ```aidl
/// assembly stud {
///     @color("tan") solid plate { body = rectangle(width: 40, height: 8) }
///     @color("silver") under = washer("m8")
///     @color("silver") top = nut("m8")
///     constrain {
///         under.seat == plate.body.top_center
///         top.seat == under.crown
///     }
/// }
/// ```
solid nut(size) {
    let s = metric(size)
    seat = point(fixed((0, 0)))
    crown = point(fixed((0, s.nut_height)))
    body = polygon(hex_corners(s.nut, s.nut_height, true))
    drawing detail at fixed((0, 0)) { faces = hex_faces(s.nut, s.nut_height, true) }
}

/// A plain washer seen from the side (ISO 7089), a flat bar.
///
/// Stands with its `origin` at `seat`, the middle of its lower face; `crown` is that of its upper one.
///
/// ```aidl
/// assembly stack {
///     @color("tan") solid plate { body = rectangle(width: 30, height: 6) }
///     @color("silver") under = washer("m6")
///     @color("silver") fixing = bolt("m6", length: 16)
///     constrain {
///         under.seat == plate.body.top_center
///         fixing.seat == under.crown
///     }
/// }
/// ```
solid washer(size) {
    let s = metric(size)
    seat = point(fixed((0, 0)))
    crown = point(fixed((0, s.washer_thickness)))
    body = rectangle(bottom_center: fixed((0, 0)), width: s.washer, height: s.washer_thickness)
}

alias hex_bolt = bolt
alias hex_nut = nut
alias plain_washer = washer
