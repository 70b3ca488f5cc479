// Metric screws, nuts and washers, and the holes that are made for them. All sizes in mm; they are exact, since no
// constraint changes what a standard says.

// The columns of the table of screws.
//   tap          drill of the thread's hole: diameter less pitch, as ISO 2306 rounds it
//   close, clearance, loose   through holes: the fine, medium and coarse series of ISO 273
//   head         of a socket head cap screw, ISO 4762, and counterbore, the bore it sinks into, DIN 974-1
//   countersink  sharp diameter of a countersunk head: ISO 10642, below M3 ISO 7046
//   nut          across flats, and nut_height, ISO 4032
//   washer       outside diameter, and washer_thickness, ISO 7089; its hole is the close one
//   bolt_head    height of a hexagon head, as wide across its flats as the nut, ISO 4014
//   pan, pan_height, pan_crown   diameter, height and radius on top of a pan head, ISO 7045; none above M10
fn screw_sizes(
    diameter: length,
    pitch: length,
    tap: length,
    close: length,
    clearance: length,
    loose: length,
    head: length,
    counterbore: length,
    countersink: length,
    nut: length,
    nut_height: length,
    washer: length,
    washer_thickness: length,
    bolt_head: length,
    pan: length,
    pan_height: length,
    pan_crown: length
) = record(
    diameter: fixed(diameter),
    pitch: fixed(pitch),
    tap: fixed(tap),
    close: fixed(close),
    clearance: fixed(clearance),
    loose: fixed(loose),
    head: fixed(head),
    counterbore: fixed(counterbore),
    countersink: fixed(countersink),
    nut: fixed(nut),
    nut_height: fixed(nut_height),
    washer: fixed(washer),
    washer_thickness: fixed(washer_thickness),
    bolt_head: fixed(bolt_head),
    pan: fixed(pan),
    pan_height: fixed(pan_height),
    pan_crown: fixed(pan_crown)
)

//          d, pitch,  tap, close, clear, loose, head, bore, sunk, nut, height, washer, thickness, bolt head, pan, height, crown
let screws = record(
    m2: screw_sizes(2, 0.4, 1.6, 2.2, 2.4, 2.6, 3.8, 4.3, 4.4, 4, 1.6, 5, 0.3, 1.4, 4, 1.6, 3.2),
    m2_5: screw_sizes(2.5, 0.45, 2.05, 2.7, 2.9, 3.1, 4.5, 5, 5.5, 5, 2, 6, 0.5, 1.7, 5, 2.1, 4),
    m3: screw_sizes(3, 0.5, 2.5, 3.2, 3.4, 3.6, 5.5, 6.5, 6.72, 5.5, 2.4, 7, 0.5, 2, 5.6, 2.4, 5),
    m4: screw_sizes(4, 0.7, 3.3, 4.3, 4.5, 4.8, 7, 8, 8.96, 7, 3.2, 9, 0.8, 2.8, 8, 3.1, 6.5),
    m5: screw_sizes(5, 0.8, 4.2, 5.3, 5.5, 5.8, 8.5, 10, 11.2, 8, 4.7, 10, 1, 3.5, 9.5, 3.7, 8),
    m6: screw_sizes(6, 1, 5, 6.4, 6.6, 7, 10, 11, 13.44, 10, 5.2, 12, 1.6, 4, 12, 4.6, 10),
    m8: screw_sizes(8, 1.25, 6.8, 8.4, 9, 10, 13, 15, 17.92, 13, 6.8, 16, 1.6, 5.3, 16, 6, 13),
    m10: screw_sizes(10, 1.5, 8.5, 10.5, 11, 12, 16, 18, 22.4, 16, 8.4, 20, 2, 6.4, 20, 7.5, 16),
    m12: screw_sizes(
        12, 1.75, 10.2, 13, 13.5, 14.5, 18, 20, 26.88, 18, 10.8, 24, 2.5, 7.5, 0, 0, 0
    )
)

// A screw may be named bare: `clearance_hole(m3)`.
let m2 = screws.m2
let m2_5 = screws.m2_5
let m3 = screws.m3
let m4 = screws.m4
let m5 = screws.m5
let m6 = screws.m6
let m8 = screws.m8
let m10 = screws.m10
let m12 = screws.m12

/// The sizes of a metric screw from M2 to M12, its nut, its washer and its holes.
///
/// They are `diameter`, `pitch`, `tap` (drill), `clearance` (and `close`, `loose`), `head`, `counterbore`, `countersink`, `nut`
/// (across flats), `nut_height`, `washer`, `washer_thickness`, `bolt_head` (height), `pan`, `pan_height`, `pan_crown`, all in mm.
/// `screws.m3` is the same as `screw("m3")`. As seen from the side they are `bolt`, `nut` and `washer`.
///
/// ```aidl
/// solid washer {
///     param size = "m8" in ["m5", "m6", "m8", "m10"]
///     body = circle(center: origin, diameter: screw(size).washer)
///     hole bore { rim = circle(center: origin, diameter: screw(size).close) }
/// }
/// ```
fn screw(size: text) =
    screws[screw_key(choice(size, ["m2", "m2.5", "m3", "m4", "m5", "m6", "m8", "m10", "m12"]))]
fn screw(size: record) = size

fn screw_key(size: text) = if size == "m2.5" then "m2_5" else size

/// The diameter of the through hole of a screw: `close`, `medium` or `loose` (ISO 273).
///
/// ```aidl
/// solid strap {
///     body = slot(start: (0, 0), end: (40, 0), width: clearance_diameter("m5") + 10)
///     hole eye { rim = slot(start: (0, 0), end: (40, 0), width: clearance_diameter("m5")) }
/// }
/// ```
fn clearance_diameter(size, fit: text = "medium") = clearance_of(
    screw(size), choice(fit, ["close", "fine", "medium", "normal", "loose", "coarse", "free"])
)
fn clearance_of(
    screw: record, fit: text
) = if fit == "close" or fit == "fine" then screw.close else if fit == "medium" or fit == "normal" then screw.clearance else screw.loose

/// The through hole of a screw, placed with `at`; in a `hole` its rim, a circle. `fit` is close, medium or loose.
///
/// ```aidl
/// solid plate {
///     body = rounded_rectangle(width: 40, height: 20, radius: 3)
///     for s in [-1, 1] {
///         hole bolt[s] { rim = clearance_hole("m4", center: (14 * s, 0)) }
///     }
/// }
/// ```
fn clearance_hole(size, center: point = (0, 0), fit: text = "medium") =
    circle(center: center, diameter: clearance_diameter(size, fit))
hole clearance_hole(size, fit: text = "medium") {
    rim = clearance_hole(size, center: fixed((0, 0)), fit: fit)
}

/// The hole to be drilled for the thread of a screw, placed with `at`; in a `hole` its rim, a circle without the thread.
///
/// ```aidl
/// solid block {
///     body = rectangle(width: 30, height: 12)
///     thread = tap_hole("m6") at (5, 0)
/// }
/// ```
fn tap_hole(size, center: point = (0, 0)) = circle(center: center, diameter: screw(size).tap)
@thread("M" + str(screw(size).diameter)) hole tap_hole(size) {
    rim = tap_hole(size, center: fixed((0, 0)))
}

/// A through hole with a bore that takes in the head of a socket head cap screw (DIN 974-1), placed with `at`. In a `drawing`
/// it is the rim of that bore; in a `hole`, too, which cuts it through.
///
/// The bore is as deep as the head is high, and 0.4 mm, above M6 0.6 mm, more: a `@depth`, so that cutters engrave its rim.
///
/// ```aidl
/// @thickness(12mm)
/// solid foot {
///     body = rectangle(center: origin, width: 60, height: 20)
///     left = counterbore("m5") at (-20, 0)
///     right = counterbore("m5") at (20, 0)
/// }
/// ```
fn counterbore(size, center: point = (0, 0)) =
    circle(center: center, diameter: screw(size).counterbore)
hole counterbore(size, fit: text = "medium") {
    bore = clearance_hole(size, center: fixed((0, 0)), fit: fit)
    @depth(screw(size).diameter + (if screw(size).diameter > 6 then 0.6 else 0.4)) hole sink {
        rim = counterbore(size, center: fixed((0, 0)))
    }
}

/// A through hole with a cone of 90° in which a flat head lies flush, placed with `at`. In a `drawing` it is the rim of that
/// cone, as wide as at its top; in a `hole`, too, which cuts it through.
///
/// The cone has a `@depth`: it is cut in STEP, STL and 3MF, and cutters engrave its rim.
///
/// ```aidl
/// @thickness(3mm)
/// solid hinge_leaf {
///     body = rectangle(center: origin, width: 30, height: 16)
///     left = countersink("m3") at (-10, 0)
///     right = countersink("m3") at (10, 0)
/// }
/// ```
fn countersink(size, center: point = (0, 0)) =
    circle(center: center, diameter: screw(size).countersink)
hole countersink(size, fit: text = "medium") {
    bore = clearance_hole(size, center: fixed((0, 0)), fit: fit)
    @depth((screw(size).countersink - clearance_diameter(size, fit)) / 2, 90deg) hole sink {
        rim = countersink(size, center: fixed((0, 0)))
    }
}

/// A pocket that holds a hexagon nut, `play` wider than it across its flats, placed with `at`; in a `hole` its outline.
///
/// ```aidl
/// solid knob {
///     body = circle(center: origin, radius: 14)
///     hole trap { nut = hex_pocket("m6", center: origin, play: 0.1) }
/// }
/// ```
shape hex_pocket(
    size, center: point = (0, 0), angle: turn = 0deg, play: length = 0.2, rotatable: bool = false
) {
    let across = screw(size).nut + play
    outline = regular_polygon(
        center: center,
        radius: across / 2 / cos(30deg),
        sides: 6,
        angle: angle,
        rotatable: rotatable
    )
    let corner = outline.corner
    let edges = outline.edges
}
hole hex_pocket(size, angle: angle = 0deg, play: length = 0.2) {
    outline = hex_pocket(size, center: fixed((0, 0)), angle: angle, play: play)
}

/// A hole for a screw to go through, to be placed with `at`.
///
/// ```aidl
/// solid rail {
///     body = rectangle(center: origin, width: 60, height: 12)
///     left = screw_hole("m4") at (-22, 0)
///     right = screw_hole("m4", fit: "loose") at (22, 0)
/// }
/// ```
hole screw_hole(size = "m3", fit: text = "medium") {
    rim = clearance_hole(size, center: fixed((0, 0)), fit: fit)
}

alias through_hole = clearance_hole
alias bolt_hole = screw_hole
alias tapped_hole = tap_hole
alias nut_trap = hex_pocket
alias nut_pocket = hex_pocket
