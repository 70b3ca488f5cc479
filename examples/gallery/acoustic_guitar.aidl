/// An acoustic guitar on its wall hook: a burst spruce top, a rosette, frets by their true law, strings and pegs.
assembly acoustic_guitar {
    param size = 380mm in 285..475
    param waist = 0.62 in 0.46..0.78
    param reach = 1.95 in 1.45..2.45
    param frets = 17 in 12..22 step 1
    param pairs = 3 in 2..4 step 1

    let u = size / 100
    let w = 50 * waist * u
    let nut_y = (36 + 100 * reach) * u
    let eye = (0, 84 * u)
    let spruce = "#eeb964"
    let rosewood = "#6b2f1b"
    let ebony = "#33241f"
    let bone = "#f5ead0"
    fn fret_y(i) = nut_y - 100 * reach * u * (1 - 2 ^ (-i / 12))
    fn lane(i, half, y) = (half * (i + 0.5) / pairs * u, y)
    fn peg(i) = (7 * u, nut_y + (12 + 24 * i / (pairs - 1)) * u)

    @color("#527a83") @shade("#22383f", -60deg) solid wall {
        v = rectangle(left: -92 * u, right: 92 * u, bottom: -14 * u, top: nut_y + 58 * u)
        drawing boards { seams = planks(v, width: 23 * u, length: 4 * size, angle: 90deg) }
    }
    @color("#8a5a34") @shade(ball) solid plate { v = circle((0, nut_y), 15 * u) }
    @color(rosewood) @shade(round) solid body {
        v = path(
            from: (0, 0),
            bezier_to((32 * u, 0), (50 * u, 12 * u), (50 * u, 38 * u)),
            bezier_to((50 * u, 56 * u), (w, 60 * u), (w, 77 * u)),
            bezier_to((w, 91 * u), (37 * u, 92 * u), (37 * u, 106 * u)),
            bezier_to((37 * u, 121 * u), (24 * u, 128 * u), (0, 128 * u)),
            mirrored(about: y_axis)
        )
    }
    @color(bone) solid binding { v = scale(body.v, 0.975, about: (0, 62 * u)) }
    for i in 0..4 {
        @color(mix("#5a2412", spruce, i / 4)) @stroke(none)
        solid burst[i] { v = scale(body.v, 0.95 - 0.035 * i, about: (0, 62 * u)) }
    }
    @color("#d59a4c") drawing grain { v = hatching(burst[4].v, 3.5 * u, angle: 90deg, margin: u) }
    @color("white") @opacity(0.2) @stroke(none) solid gloss {
        v = clip(crescent((6 * u, 36 * u), 37 * u, 36 * u, 9 * u, angle: 150deg), by: burst[1].v)
    }
    @color("#4a2016") @shade(slope)
    solid guard { v = drop((15 * u, 73 * u), radius: 11 * u, height: 36 * u, angle: 155deg) }
    @color(rosewood) solid rosette { v = circle(center: eye, radius: 18 * u) }
    @color(bone) @stroke(none)
    solid inlay { v = polar_array(circle(radius: 0.9 * u), n: 32, radius: 15.8 * u, center: eye) }
    @color("#2a1712") @shade("black") solid sound { v = circle(center: eye, radius: 13.5 * u) }
    @color(ebony) @shade(round)
    solid board { v = trapezoid(bottom_width: 15 * u, top_width: 12 * u, height: nut_y - 93 * u) }
    @color("#d8d8d0") @stroke(0.6 * u) drawing wires {
        fret = [clip(line((-8 * u, y), (8 * u, y)), by: board.v) for y in [fret_y(
            i
        ) for i in 1..frets] if y > 94 * u]
    }
    @color(ebony) @shade(slope) solid bridge {
        block = rounded_rectangle((0, 35 * u), width: 22 * u, height: 8 * u, radius: 2 * u)
        wings = rhombus((0, 35 * u), width: 44 * u, height: 9 * u)
    }
    @color(rosewood) @shade(round) solid head at (0, nut_y + 2 * u) {
        flare = trapezoid(bottom_width: 12 * u, top_width: 19 * u, height: 8 * u)
        blade = trapezoid(bottom_width: 19 * u, top_width: 22 * u, height: 33 * u)
        crest = dome(width: 22 * u, height: 4 * u)
        constrain column(crest, blade, flare, gap: 0, align: center)
        @color("gold") drawing label { maker = text("Luna", (0, 38 * u), 3.6 * u) }
    }
    @color(bone) solid bones {
        for i in [3, 5, 7, 9, 12] { dot[i] = circle(center: (0, fret_y(i - 0.5)), radius: 1.1 * u) }
        nut = rectangle(center: (0, nut_y + u), width: 12.4 * u, height: 2 * u)
        saddle = slot(center: (0, 37 * u), length: 17 * u, width: 1.2 * u)
        pin = [circle(lane(i, 6.2, 33 * u), 0.8 * u) for i in -pairs..<pairs]
    }
    @color("#e6e0d0") @shade(ball) assembly pegs {
        for i in 0..<pairs {
            solid stem[i] { v = strip(peg(i), peg(i) + (9 * u, 0), 1.4 * u) }
            solid key[i] { v = squircle(peg(i) + (10 * u, 0), width: 5 * u, height: 5.5 * u) }
            solid post[i] { v = circle(peg(i), radius: 1.7 * u) }
        }
    }
    other_pegs = mirror(pegs, about: y_axis)
    @color("#fffbe8") @stroke(0.45 * u) drawing right_strings {
        string = [polyline(
            lane(i, 6.2, 33 * u), lane(i, 4.8, nut_y), peg(pairs - 1 - i)
        ) for i in 0..<pairs]
    }
    left_strings = mirror(right_strings, about: y_axis)
    @color("#2b2420") @shade(ball)
    solid hook { v = [circle((s * 9 * u, nut_y + 2 * u), radius: 2.6 * u) for s in [-1, 1]] }

    @color("black") @opacity(0.3) @stroke(none) @behind(body) solid shadow {
        v = [copy(p, by: (6 * u, -6 * u)) for p in [body.v, board.v, head.blade]]
    }

    constrain {
        board.below(bones.nut, gap: 0, align: center)
        head.on_top_of(bones.nut, align: center)
    }
}
