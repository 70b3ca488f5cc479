// Joints for sheets that a laser or a router cuts. A beam takes half the `kerf` away on either side of a line, so that
// tabs are drawn that much wider and slots that much narrower at each of their sides.

/// A panel with finger joints: `width` and `height` are those of the whole, tabs included.
///
/// `edges` says of the bottom, right, top and left edge whether it is "tabs" (with a tab at both ends), "notches" (with
/// a notch at both ends; it fits a "tabs" edge of the same length) or "flat"; opposite edges may share a word. An edge
/// has an odd number of equal parts about as wide as `finger`; two to five times the thickness is customary.
///
/// ```aidl
/// @thickness(3mm)
/// solid front {
///     body = finger_panel(width: 100, height: 60, thickness: 3, edges: ["notches", "tabs", "flat", "tabs"])
/// }
/// ```
shape finger_panel(
    width: length,
    height: length,
    thickness: length,
    finger = 3 * written(thickness),
    edges: list = ["tabs"],
    kerf: length = 0,
    center: point = (0, 0)
) {
    assert len(edges) in [1, 2, 4], "the edges of a panel are named by one, two or four words"
    if not finger > 0mm { assert false, "the fingers of a panel have a width" }
    let kinds = [choice(edges[i % len(edges)], ["tabs", "notches", "flat"]) for i in 0..3]
    let ways = [(1mm, 0mm), (0mm, 1mm), (-1mm, 0mm), (0mm, -1mm)]
    let sizes = [width, height, width, height]
    let corners = [center + (x * width / 2, y * height / 2) for x, y in [
        [-1, -1], [1, -1], [1, 1], [-1, 1]
    ]]
    let side = [fingers(
        corners[i], ways[i], sizes[i], thickness, finger, kerf, kinds[i]
    ) for i in 0..3]
    for i in 0..3 {
        let part = sizes[i] / finger_count(sizes[i], finger, kinds[i])
        assert kinds[i] == "flat" or part > thickness + kerf,
            "the fingers of a panel are wider than it is thick"
    }
    // Where the edges on both sides of a corner begin with a notch, the corner belongs to neither.
    let ends = [corners[i] + ways[(i + 1) % 4] * (finger_inset(
        kinds[i], thickness
    ) / 1mm) + ways[i] * (finger_inset(kinds[i - 1], thickness) / 1mm) for i in 0..3]
    outline = polygon(
        [ends[0]] + side[0] + [ends[1]] + side[1] + [ends[2]] + side[2] + [ends[3]] + side[3]
    )
}

/// One edge with fingers for an outline of your own; the material lies to the left of the way from start to end.
///
/// `edge` is "tabs" or "notches", as in `finger_panel`. The line from start to end is the outer one, over the tabs; the
/// edge itself, `outline`, has a `start` and an `end` of its own, which lie further in if it begins with a notch.
///
/// ```aidl
/// @thickness(4mm)
/// solid gable {
///     foot = finger_edge(start: (0, 0), end: (80, 0), thickness: 4, kerf: 0.2)
///     roof = polyline(foot.outline.end, (80, 30), (40, 60), (0, 30), foot.outline.start)
/// }
/// ```
shape finger_edge(
    start: point,
    end: point,
    thickness: length,
    finger = 3 * written(thickness),
    kerf: length = 0,
    edge: text = "tabs"
) {
    assert norm(written(end - start)) > 0, "an edge has a length"
    let kind = choice(edge, ["tabs", "notches"])
    let way = unit(end - start)
    let deep = turned(way, 90deg) * (finger_inset(kind, thickness) / 1mm)
    outline = polyline(
        [start + deep] + fingers(start, way, norm(end - start), thickness, finger, kerf, kind) + [
            end + deep
        ]
    )
}

/// Slots in the middle of a sheet for the tabs of a "tabs" (or "notches") edge that stands on the line through them.
///
/// ```aidl
/// @thickness(3mm)
/// solid wall {
///     sheet = rectangle(center: (0, 0), width: 100, height: 60)
///     hole shelf { slots = finger_slots(start: (-40, 0), end: (40, 0), thickness: 3, finger: 12, kerf: 0.15) }
/// }
/// ```
shape finger_slots(
    start: point,
    end: point,
    thickness: length,
    finger = 3 * written(thickness),
    kerf: length = 0,
    edge: text = "tabs"
) {
    assert norm(written(end - start)) > 0, "an edge has a length"
    let kind = choice(edge, ["tabs", "notches"])
    let way = unit(end - start)
    let count = finger_count(norm(end - start), finger, kind)
    let pitch = norm(end - start) / count
    let first = if kind == "tabs" then 0 else 1
    for i in 0..<(count + 1) / 2 - first {
        let middle = start + way * (pitch * (2 * i + first + 0.5) / 1mm)
        slot[i] = polygon(rectangle_on(middle, way, pitch - kerf, thickness - kerf))
    }
}

// The corners of a rectangle about a point, along a way of 1 mm.
fn rectangle_on(
    middle: point, way: point, length: length, width: length
) = [middle + way * (x * length / 2mm) + turned(way, 90deg) * (y * width / 2mm) for x, y in [
    [-1, -1], [1, -1], [1, 1], [-1, 1]
]]

fn finger_inset(kind: text, thickness: length) = if kind == "notches" then thickness else fixed(0mm)

// The odd number of parts into which an edge is divided.
fn finger_count(length: length, finger: length, kind: text) =
    if kind == "flat" then 1 else 2 * max(1, floor(written(length) / finger / 2)) + 1

// The corners of an edge between its ends: two where a part ends and the next begins, one on the level of each.
fn fingers(
    start: point,
    way: point,
    length: length,
    thickness: length,
    finger: length,
    kerf: length,
    kind: text
) = fingers_between(
    start,
    way,
    turned(way, 90deg),
    length / finger_count(length, finger, kind),
    thickness,
    kerf,
    finger_count(length, finger, kind),
    first: if kind == "tabs" then 0 else 1
)
fn fingers_between(
    start: point,
    way: point,
    deep: point,
    pitch: length,
    thickness: length,
    kerf: length,
    count: integer,
    first: integer
) = fingers_at(
    [start + way * ((pitch * (part + 1) + kerf / 2 * (1 - 2 * ((part + first) % 2))) / 1mm) for part in 0..<count - 1],
    [deep * (thickness * ((k + first) % 2) / 1mm) for k in [0, 1, 1, 0]]
)
fn fingers_at(ends: list, levels: list) =
    [ends[(j - j % 2) / 2] + levels[j % 4] for j in 0..<2 * len(ends)]

/// A T-slot for a screw and a captive nut, cut into a sheet from its edge: `mouth` is on the edge, `angle` points in.
///
/// The sizes are those of an M3 screw and nut unless others are given; `depth` is how far the screw reaches in,
/// `nut_at` how far the nut is from the edge.
///
/// ```aidl
/// solid wall {
///     sheet = rectangle(center: (0, 0), width: 60, height: 40)
///     hole nut { cut = t_slot(mouth: (0, 20), angle: -90deg, depth: 12) }
/// }
/// ```
shape t_slot(
    mouth: point,
    depth: length,
    angle: angle = 90deg,
    screw_diameter: length = 3.2,
    nut_width: length = 5.5,
    nut_thickness: length = 2.4,
    nut_at: length = depth / 2,
    kerf: length = 0
) {
    let s = (screw_diameter - kerf) / 2
    let n = (nut_width - kerf) / 2
    let near = nut_at + kerf / 2
    let far = nut_at + nut_thickness - kerf / 2
    let right = [(0mm, -s), (near, -s), (near, -n), (far, -n), (far, -s), (depth, -s)]
    let left = [(depth, s), (far, s), (far, n), (near, n), (near, s), (0mm, s)]
    outline = polygon([mouth + turned(p, angle) for p in right + left])
    assert far < depth, "the nut lies beyond the end of its slot"
}

/// A rectangular opening for a router: arcs of the tool's diameter clear the corners, so that a square part fits in.
///
/// ```aidl
/// solid plate {
///     sheet = rectangle(center: (0, 0), width: 60, height: 40)
///     hole pocket { rim = dogbone_rectangle(center: (0, 0), width: 40, height: 20, tool: 6) }
/// }
/// ```
shape dogbone_rectangle(width: length, height: length, tool: length, center: point = (0, 0)) {
    let reach = tool / sqrt(2)
    let a = width / 2
    let b = height / 2
    bottom = line(center + (reach - a, -b), center + (a - reach, -b))
    right = line(center + (a, reach - b), center + (a, b - reach))
    top = line(center + (a - reach, b), center + (reach - a, b))
    left = line(center + (-a, b - reach), center + (-a, reach - b))
    let edges = [bottom, right, top, left]
    for i in 0..3 {
        corner[i] = arc(
            center: (edges[i].end + edges[(i + 1) % 4].start) / 2,
            start: edges[i].end,
            end: edges[(i + 1) % 4].start
        )
    }
    assert width > 2 * reach and height > 2 * reach, "the tool is too large for this opening"
}

/// The hole that a tool drills into an inner corner so that a square one fits: its rim goes through the corner.
///
/// `angle` is the direction from the corner into the opening.
///
/// ```aidl
/// solid plate {
///     sheet = rectangle(center: (0, 0), width: 60, height: 40)
///     hole opening {
///         rim = rectangle(center: (0, 0), width: 30, height: 20)
///         for i in 0..3 { relief[i] = corner_relief(rim.corners[i], angle: 45deg + i * 90deg, tool: 6) }
///     }
/// }
/// ```
fn corner_relief(corner: point, angle: angle, tool: length) =
    circle(center: corner + polar(tool / 2, angle), radius: tool / 2)

/// Slits that let a stiff sheet bend about an upright axis: columns `spacing` apart, set off by half a slit in turns.
///
/// It covers `width` along the bend and the whole `height` of the sheet, where every other column runs out. `rows` is
/// the number of slits one above the other, `link` what stays between two, customarily twice the thickness or less;
/// the more columns, the tighter it bends.
///
/// ```aidl
/// solid cover {
///     sheet = rectangle(center: (0, 0), width: 120, height: 60)
///     hole bend { slits = living_hinge(width: 30, height: 60, rows: 2, spacing: 3, slit: 0.4) }
/// }
/// ```
shape living_hinge(
    width: length,
    height: length,
    rows: integer = 3,
    spacing = 2mm,
    link: length = 3,
    slit: length = 0.2,
    center: point = (0, 0)
) {
    assert rows >= 1, "a hinge has at least one row of slits"
    if not spacing > 0 { assert false, "the columns of a hinge are some way apart" }
    let columns = hinge_columns(written(width), spacing)
    let row = height / max(rows, 1)
    for i in 0..columns {
        let middle = center + (width * (i / columns - 0.5), 0mm)
        let offset = if i % 2 == 0 then 0.5 else 0
        for k in 0..<rows + i % 2 {
            // At the borders of the sheet a slit is cut through the edge.
            let low = if i % 2 == 1 and k == 0 then -slit else row * (k + offset - 0.5) + link / 2
            let high = if i % 2 == 1 and k == rows then height + slit else row * (k + offset + 0.5) - link / 2
            cut[i][k] = polygon(
                rectangle_on(
                    middle + (0mm, (low + high - height) / 2), (0mm, 1mm), high - low, slit
                )
            )
        }
    }
    assert row > link, "the links of the hinge are longer than its slits"
}

fn hinge_columns(width: length, spacing: length) = max(1, round(width / spacing))

alias box_panel = finger_panel
alias captive_nut = t_slot
alias lattice_hinge = living_hinge
alias kerf_bend = living_hinge
