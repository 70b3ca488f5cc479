// Patterns of holes: for bolts on a circle or at corners, and for what is bought ready-made.

// The width of a hole: a number is the diameter itself, a screw asks for its through hole.
fn hole_diameter(size: length, fit: text) = size
fn hole_diameter(size: text, fit: text) = clearance_diameter(size, fit)
fn hole_diameter(size: record, fit: text) = clearance_diameter(size, fit)

// The corners of a rectangle about the origin, counter-clockwise from the lower left, exact.
fn corners_about_origin(width, height) = [
    fixed((-width / 2, -height / 2)),
    fixed((width / 2, -height / 2)),
    fixed((width / 2, height / 2)),
    fixed((-width / 2, height / 2))
]

/// Holes for bolts at equal steps on a circle of a `diameter`, the first at `start_angle`; placed with `at`.
///
/// `size` is a screw, whose through hole is taken, or the diameter of the holes. They are `rim[0]`, `rim[1]` and so on.
///
/// ```aidl
/// solid flange {
///     body = circle(center: origin, radius: 40)
///     hole bore { rim = circle(center: origin, radius: 15) }
///     bolts = bolt_circle(6, diameter: 62, size: "m6") at origin
/// }
/// ```
hole bolt_circle(
    count: integer = 4,
    diameter: length,
    size = "m3",
    start_angle: angle = 0deg,
    fit: text = "medium"
) {
    assert count >= 1, "a circle of bolts has at least one hole"
    for i in 0..<count {
        rim[i] = circle(
            center: fixed(polar(diameter / 2, start_angle + 360deg / count * i)),
            diameter: fixed(hole_diameter(size, fit))
        )
    }
}

/// Four holes at the corners of a rectangle of `width` and `height`, middle to middle; placed with `at`.
///
/// They are `rim[0]` to `rim[3]`, counter-clockwise from the lower left. `size` is a screw or the diameter of the holes.
///
/// ```aidl
/// solid lid {
///     plate = rounded_rectangle(center: origin, width: 80, height: 50, radius: 5)
///     bolts = hole_rectangle(70, 40, size: "m3") at origin
/// }
/// ```
hole hole_rectangle(width: length, height: length, size = "m3", fit: text = "medium") {
    let corners = corners_about_origin(width, height)
    for i in 0..3 {
        rim[i] = circle(center: corners[i], diameter: fixed(hole_diameter(size, fit)))
    }
}

// --- Stepper motors: NEMA ICS 16 -------------------------------------------------------------------

// body   side of the square flange of usual motors; the standard leaves it open
// bolts  side of the square of the bolts, which for 17, 23 and 34 is 1.725, 2.625 and 3.875 inches across
// pilot  the round boss around the shaft
// screw  that usual flanges take
fn motor_sizes(body: length, bolts: length, pilot: length, screw: text) =
    record(body: fixed(body), bolts: fixed(bolts), pilot: fixed(pilot), screw: screw)

let nema = record(
    n14: motor_sizes(35.2, 26, 22, "m3"),
    n17: motor_sizes(42.3, 31, 22, "m3"),
    n23: motor_sizes(56.4, 47.14, 38.1, "m5"),
    n34: motor_sizes(86, 69.6, 73.025, "m5")
)
let nema14 = nema.n14
let nema17 = nema.n17
let nema23 = nema.n23
let nema34 = nema.n34

/// The flange of a stepper motor by its NEMA size, 14, 17, 23 or 34: `body`, `bolts`, `pilot`, `screw`.
///
/// `bolts` is the side of the square of its four screws, `pilot` the diameter of its boss. `nema.n17`, `nema17`,
/// `nema(17)` and `nema("17")` are the same.
///
/// ```aidl
/// solid spacer {
///     body = rounded_rectangle(center: origin, width: nema(17).body, height: nema(17).body, radius: 4)
///     mount = motor_mount("nema17") at origin
/// }
/// ```
fn nema(size: text) = nema["n" + nema_number(
    choice(size, ["14", "17", "23", "34", "nema14", "nema17", "nema23", "nema34"])
)]
fn nema(size: integer) = nema(str(size))
fn nema(size: record) = size

fn nema_number(size: text) = if size in ["14", "nema14"] then "14" else if size in [
    "17", "nema17"
] then "17" else if size in ["23", "nema23"] then "23" else "34"

/// The holes of a stepper motor: four bolts `rim[i]` and the `pilot`, which is `play` wider than the motor's boss.
///
/// ```aidl
/// solid plate {
///     body = rounded_rectangle(center: (0, 0), width: 60, height: 60, radius: 5)
///     motor = motor_mount(nema17)
///     constrain motor.centered_in(body)
/// }
/// ```
hole motor_mount(motor = "nema17", play: length = 0.4, fit: text = "medium") {
    let flange = nema(motor)
    let corners = corners_about_origin(flange.bolts, flange.bolts)
    pilot = circle(center: fixed((0, 0)), diameter: fixed(flange.pilot + play))
    for i in 0..3 {
        rim[i] = clearance_hole(flange.screw, center: corners[i], fit: fit)
    }
}

// --- Screens and boards ----------------------------------------------------------------------------

/// The holes of a flat screen, 75 or 100 mm apart, for M4 screws (VESA MIS-D).
///
/// ```aidl
/// solid bracket {
///     plate = rounded_rectangle(center: origin, width: 115, height: 115, radius: 8)
///     screen = vesa_mount(100) at origin
/// }
/// ```
hole vesa_mount(size: length = 100, fit: text = "medium") {
    assert size == 75 or size == 100, "VESA MIS-D has holes 75 or 100 mm apart"
    let corners = corners_about_origin(size, size)
    for i in 0..3 {
        rim[i] = clearance_hole("m4", center: corners[i], fit: fit)
    }
}

/// The four holes of a Raspberry Pi (models B+ to 5), 58 by 49 mm, for M2.5 screws; about their middle.
///
/// The board is 85 by 56 mm, and its left and lower holes are 3.5 mm from its edges.
///
/// ```aidl
/// solid tray {
///     floor = rounded_rectangle(center: origin, width: 90, height: 60, radius: 4)
///     board = raspberry_pi_mount() at (-10, 0)
/// }
/// ```
hole raspberry_pi_mount(fit: text = "close") {
    let corners = corners_about_origin(58, 49)
    for i in 0..3 {
        rim[i] = clearance_hole("m2.5", center: corners[i], fit: fit)
    }
}

// --- Ball bearings: boundary dimensions of ISO 15 ----------------------------------------------------

fn bearing_sizes(bore: length, outside: length, width: length) =
    record(bore: fixed(bore), outside: fixed(outside), width: fixed(width))

let bearings = record(
    b623: bearing_sizes(3, 10, 4),
    b624: bearing_sizes(4, 13, 5),
    b625: bearing_sizes(5, 16, 5),
    b626: bearing_sizes(6, 19, 6),
    b608: bearing_sizes(8, 22, 7),
    b6000: bearing_sizes(10, 26, 8),
    b6001: bearing_sizes(12, 28, 8),
    b6002: bearing_sizes(15, 32, 9),
    b6200: bearing_sizes(10, 30, 9),
    b6201: bearing_sizes(12, 32, 10),
    b6202: bearing_sizes(15, 35, 11)
)

/// A ball bearing by its number, as 608: `bore`, `outside` and `width`.
///
/// There are 623 to 626, 608, 6000 to 6002 and 6200 to 6202; `bearings.b608` is the same as `bearing(608)`.
///
/// ```aidl
/// solid stand_in {
///     let sizes = bearing(608)
///     body = ring(center: origin, outer_radius: sizes.outside / 2, inner_radius: sizes.bore / 2)
/// }
/// ```
fn bearing(number: text) = bearings["b" + choice(
    number, ["623", "624", "625", "626", "608", "6000", "6001", "6002", "6200", "6201", "6202"]
)]
fn bearing(number: integer) = bearing(str(number))

/// The hole that a ball bearing is pressed into, `play` wider than it, placed with `at`; in a `hole` its rim.
///
/// ```aidl
/// solid wheel {
///     rim = circle(center: origin, radius: 30)
///     hole hub { seat = bearing_seat(608, center: origin) }
/// }
/// ```
fn bearing_seat(number, center: point = (0, 0), play: length = 0) =
    circle(center: center, diameter: fixed(bearing(number).outside + play))
hole bearing_seat(number, play: length = 0) {
    rim = bearing_seat(number, center: fixed((0, 0)), play: play)
}

alias bolt_pattern = bolt_circle
alias corner_holes = hole_rectangle
alias four_holes = hole_rectangle
alias nema_mount = motor_mount
