// What joins two parts: rams, links, wires, hinges, brackets, straps, rivets and screws. They follow the points or outlines they
// are made of, which may be of other structures; all else of them is worked out from these, so they hold no equations.

/// A ram from `start` to `end`: a cylinder, `barrel` across, and its rod, `rod` across, each with an eye about its end.
///
/// Over a `share` of the way it is the barrel; with a `length` this is how far the barrel reaches beyond `start`, and only the
/// rod gives way. `bore` is the diameter of the eyes; 0 leaves them out. `start` and `end` may be points of any structure above,
/// which it follows. `mouth` is where the rod leaves the barrel.
///
/// ```aidl
/// assembly loader {
///     @color("goldenrod") solid mast { body = rectangle(center: (0, 30), width: 16, height: 60) }
///     @color("goldenrod") solid boom { body = rectangle(center: (35, 64), width: 90, height: 8) }
///     @color("dimgray") solid lift {
///         body = ram(mast.body.bottom_center.up(8), boom.body.bottom_right.left(25), barrel: 10, rod: 5)
///         @color("silver") shine = strip(body.mouth, lerp(body.mouth, body.end, 0.8), 5)
///     }
/// }
/// ```
shape ram(
    start: point,
    end: point,
    barrel: length,
    rod: length = barrel / 2,
    share: number = 0.55,
    bore: length = rod / 2
) {
    let way = atan2(end.y - start.y, end.x - start.x)
    let reach = norm(end - start)
    let lip = barrel / 5
    let eye = (barrel + rod) / 4
    let neck = asin(rod / 2 / eye)
    fn place(x, y) = start + turned((x, y), way)
    assert rod < barrel, "the rod of a ram is thinner than its barrel"
    assert share * reach > barrel / 2 + lip and share * reach < reach - eye,
        "the barrel of a ram is longer than it is wide, and ends before the eye of its rod"
    let mouth = place(share * reach, 0)
    foot = arc(center: start, radius: barrel / 2, start_angle: way + 90deg, end_angle: way + 270deg)
    head = arc(
        center: end, radius: eye, start_angle: way + 180deg + neck, end_angle: way + 180deg - neck
    )
    let right = [
        foot.end,
        place(share * reach - lip, -barrel / 2),
        place(share * reach - lip, -barrel * 0.58),
        place(share * reach, -barrel * 0.58),
        place(share * reach, -rod / 2),
        head.start
    ]
    let left = [
        head.end,
        place(share * reach, rod / 2),
        place(share * reach, barrel * 0.58),
        place(share * reach - lip, barrel * 0.58),
        place(share * reach - lip, barrel / 2),
        foot.start
    ]
    for i in 0..4 {
        right_edge[i] = line(right[i], right[i + 1])
        left_edge[i] = line(left[i], left[i + 1])
    }
    if is_some(bore) {
        eye_hole[0] = circle(center: start, radius: bore / 2)
        eye_hole[1] = circle(center: end, radius: bore / 2)
    }
}
fn ram(
    start: point,
    end: point,
    barrel: length,
    rod: length = barrel / 2,
    length: length,
    bore: length = rod / 2
) = ram(start, end, barrel, rod, share: length / max(norm(end - start), 0.001), bore: bore)

/// A bar with round ends and eyes from `start` to `end`, `width` across: a link, a coupling rod or a strut between two parts.
///
/// `eyes` are spread evenly from end to end, each `bore` wide; 0 leaves them out. `start` and `end` may be points of any structure
/// above, which it follows. Lies with eyes half as wide.
///
/// ```aidl
/// assembly crank_drive {
///     @color("firebrick") solid disc { body = circle(center: (0, 0), radius: 20) }
///     @detached @color("gray") solid slider { body = rectangle(center: (70, 0), width: 24, height: 14) }
///     @color("silver") solid rod { body = link(disc.body.center.up(13), slider.body.center, width: 8) }
/// }
/// ```
shape link(start: point, end: point, width: length, bore: length = width / 2, eyes: integer = 2) {
    let way = atan2(end.y - start.y, end.x - start.x)
    assert bore < width, "the eyes of a link are smaller than it is wide"
    assert eyes >= 2, "a link has an eye at each end; `bore: 0` leaves them out"
    near = arc(center: start, radius: width / 2, start_angle: way + 90deg, end_angle: way + 270deg)
    far = arc(center: end, radius: width / 2, start_angle: way - 90deg, end_angle: way + 90deg)
    right = line(near.end, far.start)
    left = line(far.end, near.start)
    if is_some(bore) {
        for i in 0..<eyes {
            eye[i] = circle(center: lerp(start, end, i / max(1, eyes - 1)), radius: bore / 2)
        }
    }
}

/// A wire, a rope or a rod from `start` to `end`, `width` across: straight, or in the middle by `sag` below the straight way.
///
/// `start` and `end` may be points of any structure above, which it follows.
///
/// ```aidl
/// assembly lantern {
///     solid hood { body = dome(bottom_center: (0, 60), width: 50, height: 16) }
///     solid tank { body = trapezoid(center: (0, 0), bottom_width: 60, top_width: 46, height: 20) }
///     @color("dimgray")
///     solid guard {
///         left = wire(tank.body.top_left, hood.body.bottom_right, 2)
///         right = wire(tank.body.top_right, hood.body.bottom_left, 2)
///     }
/// }
/// ```
fn wire(start: point, end: point, width: length, sag: length = 0) =
    thick(cord(start, end, sag), width, caps: butt)

/// A hinge along the joint of two parts, from `start` to `end`: two leaves with knuckles about a pin, and holes for screws.
///
/// A `leaf` reaches that far to either side, knuckles included, which are `pin` across; the first is of the leaf on the left of
/// its way. `play` is the gap between what turns. `screws` are in each leaf, `bore` wide; with 0 there are none.
///
/// ```aidl
/// assembly cupboard {
///     @color("peru") solid post { body = rectangle(center: (-20, 0), width: 40, height: 90) }
///     @color("burlywood") solid door { body = rectangle(center: (30, 0), width: 60, height: 90) }
///     @color("silver") solid lower { body = hinge(door.body.bottom_left.up(10), door.body.bottom_left.up(40), leaf: 14) }
/// }
/// ```
shape hinge(
    start: point,
    end: point,
    leaf: length,
    knuckles: integer = 5,
    pin: length = leaf / 3,
    screws: integer = 2,
    bore: length = leaf / 6,
    play: length = leaf / 40
) {
    let way = unit(end - start)
    let side = turned(way, 90deg)
    let reach = norm(end - start)
    let count = max(2, knuckles)
    let pitch = reach / count
    fn place(x, y) = start + way * (x / 1mm) + side * (y / 1mm)
    assert knuckles >= 2, "a hinge has two knuckles or more"
    assert screws >= 0, "there are no fewer screws than none"
    assert leaf > pin, "the leaves of a hinge are wider than its knuckles"
    for k in 0..1 {
        let out = 1 - 2 * k
        let inner = [place(
            pitch * (i + j) + play / 2 * (if i == 0 and j == 0 or i == count - 1 and j == 1 then 0 else 1 - 2 * j) * (if i % 2 == k then 1 else -1),
            if i % 2 == k then -out * pin / 2 else out * (pin / 2 + play)
        ) for i in 0..<count for j in 0..1]
        plate[k] = polygon([place(reach, out * leaf), place(0mm, out * leaf)] + inner)
        if is_some(bore) {
            for i in 0..<screws {
                screw_hole[k][i] = circle(
                    center: place(reach * (i + 0.5) / screws, out * (leaf + pin / 2 + play) / 2),
                    radius: bore / 2
                )
            }
        }
    }
}

/// An angle bracket in the corner of two parts: a leg of `width` to the right of its `corner`, one of `height` up, and a brace.
///
/// `angle` turns it about its corner: at -90deg the first leg goes down and the second to the right, at 180deg they go to the left
/// and down. `brace` is how wide the brace between the legs is; 0 leaves it out, and a wide one fills the corner. `corner` may be a
/// point of any structure above, which it follows.
///
/// ```aidl
/// assembly shelf {
///     @color("tan") solid wall { body = rectangle(center: (0, 0), width: 8, height: 80) }
///     @color("peru") solid board { body = rectangle(bottom_left: (4, 20), width: 70, height: 6) }
///     @color("dimgray") solid arm { body = bracket(board.body.bottom_left, width: 40, height: 50, thickness: 4, angle: -90deg) }
/// }
/// ```
shape bracket(
    corner: point,
    width: length,
    height: length,
    thickness: length,
    brace: length = thickness,
    angle: angle = 0deg
) {
    let a = width - thickness
    let b = height - thickness
    let slope = hypot(a, b)
    fn place(x, y) = corner + turned((x, y), angle)
    assert thickness < width and thickness < height,
        "the legs of a bracket are longer than they are thick"
    if is_some(brace) {
        outline = polygon(
            [
                place(0, 0),
                place(width, 0),
                place(width, thickness),
                place(thickness, height),
                place(0, height)
            ]
        )
        if written(brace * slope / b) < 0.9 * written(a) {
            opening = polygon(
                [
                    place(thickness, thickness),
                    place(width - brace * slope / b, thickness),
                    place(thickness, height - brace * slope / a)
                ]
            )
        }
    } else {
        outline = polygon(
            [
                place(0, 0),
                place(width, 0),
                place(width, thickness),
                place(thickness, thickness),
                place(thickness, height),
                place(0, height)
            ]
        )
    }
}

/// A strap drawn tight around an outline, or around a list of them as a belt: `width` thick, straight over what is hollow.
///
/// The outlines may be of any structure above, which it follows.
///
/// ```aidl
/// assembly drive {
///     @color("gray") solid motor { body = circle(center: (0, 0), radius: 10) }
///     @color("gray") solid fan { body = circle(center: (60, 15), radius: 22) }
///     @color("black") solid belt { body = strap_around([motor.body, fan.body], 3) }
/// }
/// ```
fn strap_around(of, width: length) = cut(offset(hull(of), width, corners: round), by: hull(of))

/// Round heads of rivets, `diameter` across, `inset` within an outline: one in each of its corners, and evenly between.
///
/// There are as many as `n` says in all, or they are a `pitch` apart as near as goes. Of an open curve both ends have one, `inset` from them.
/// It follows the outline, a line, a path or whatever is made of lines, and arcs without a corner at them, of any structure above.
///
/// ```aidl
/// solid plate {
///     body = rounded_rectangle(width: 70, height: 44, radius: 8)
///     @color("silver") heads = rivets(body, pitch: 12, inset: 5, diameter: 4)
/// }
/// ```
fn rivets(along, n: integer, inset: length, diameter: length) =
    along(circle(radius: diameter / 2), along, n: n, margin: inset)
fn rivets(along, pitch: length, inset: length, diameter: length) =
    along(circle(radius: diameter / 2), along, pitch: pitch, margin: inset)

/// Heads of screws seen from above, by their `size`, `inset` within an outline: one in each of its corners, and evenly between.
///
/// They are placed as `rivets` are. `drive` is the recess in the heads, cut out of them: slot, cross, hex or none.
///
/// ```aidl
/// solid cover {
///     body = rectangle(width: 70, height: 44)
///     @color("silver") heads = screws(body, n: 6, inset: 6, size: "m4", drive: "hex")
/// }
/// ```
fn screws(along, n: integer, inset: length, size = "m3", drive: text = "cross") =
    along(screw_head(size, drive), along, n: n, margin: inset)
fn screws(along, pitch: length, inset: length, size = "m3", drive: text = "cross") =
    along(screw_head(size, drive), along, pitch: pitch, margin: inset)

// The head of a screw about the origin, with a recess half as wide; that of a cross has three fifths.
shape screw_head(size, drive: text) {
    let kind = choice(drive, ["slot", "cross", "hex", "none"])
    let r = metric(size).head / 2
    let turns = if kind == "cross" then 4 else 2
    rim = circle(center: (0, 0), radius: r)
    if kind == "hex" {
        recess = polygon([polar(r / 2, 60deg * i) for i in 0..5])
    } else if kind != "none" {
        recess = polygon(
            [polar(1mm, 90deg * i) * (x * r / 5mm) + polar(
                1mm, 90deg * i + 90deg
            ) * (y * r / 5mm) for i in 0..3 for x, y in (if kind == "cross" then [
                [3, -1], [3, 1], [1, 1]
            ] else if i % 2 == 0 then [[4, -1], [4, 1]] else [])]
        )
    }
}
