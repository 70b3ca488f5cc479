// A program in which every class of tokens occurs. 𝒳 lies beyond the first plane of Unicode.
# another comment
/* and one
   over * two / lines */
import "parts.aidl"
import "screws.aidl" as screws
import washer, nut from 'more.aidl'

alias flach = horizontal
let größe = 2 * pi * math.sqrt(2) - np.pi
fn half(x: number, f = 2) = x / f if f != 0 else 0mm
fn 大きい(値) = if 値 > 5 then true else false

/// Two lines that cross.
shape crossing(
    center: point = (0, 0),
    size: length,
    mark: crossing = crossing(center: (0, 0), size: 2)
) {
    across = line(center - (size / 2, 0), center + (size / 2, 0))
    construction upright = line(start: center, length: size ^ 1 ** 1, angle: 90°)
}

//// Four slashes are no documentation.
constraint diagonal_to(a: box, b: box, by: length = 3mm) {
    a.top == b.bottom - by; a.left = b.right + by
    if by > 0 { a.width <= b.width, a.height >= 1 } else if by < 0 { let z = 1 } else { a.wider(b) }
    for i in 0..<2 { a.left == b.left }
}

@thickness(3mm)
@material("birch \"ply\"\twood")
@color(red) @detached
assembly 𝒳_machine at (0, 0) rotated 30deg {
    param width = 120.5mm in 60..300 step 0.5
    param kind = 'a' in ["a", 'b']
    param part = 5 in 1..<9
    var gap = 1e-3in
    let flags = [True, False, true && !false || not true and false or True]
    let squares = [half(k) for k, l in enumerate([1, 2]) if k % 2 == 1]

    template solid peg(length = 40, radius: length = 4) at (0, 0) {
        shaft = rectangle(center: origin, width: radius, height = length)
    }
    part body_1 { todo }
    Sub_Assembly group[0][1] rotated 0.5turn { axis = x_axis }
    for i in 0..3, j in 0..20 step 5 {
        hole screw[i, j] at (i * 10, j) {
            rim = circle(radius: guess(2cm) + .5ft)
            solid island { rim = ring(center: self.origin, outer_radius: 1, inner_radius: 0.5rad) }
        }
        pegs[i][j] = peg(length: 30) at (30 * i, -5)
        @layer("cut")
        more[i] = screws.washer(outer: 3).rim.center
    }
    from = path(from: (0, 0), right(30), line_by((-8, 6)), close())
    fillet(from.corners[-1], 2)
    move(shaft, by: (1, 2))
    constrain flach(from)
    constrain a.x = 3
    constrain if width > 3 then a.b else c.d
    constrain for p in pegs { p.above(body_1, gap: 0), p.diagonal_to(body_1) }
    constrain {
        evenly_spaced(pegs, axis: x); x in 3..5; y not in 1..2
        let w = 5
        for p, q in [pegs, pegs] { p.left == q.right }
        if width >= 3 { tangent(a, b) }
    }
    prefer gap == 5mm weight 2
    assert width <= 2m, "zu groß: 𝒳"
    if n > 2 { x = 1 } else { x = 2 }
}
