/// An acoustic guitar: a waisted spruce top, a rosette, frets by their true law, strings and pegs.
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
    let spruce = "#e3b36b"
    let red = "#8a4b2a"
    let ebony = "#3b2a25"
    let bone = "#f5ead0"
    fn fret_y(i) = nut_y - 100 * reach * u * (1 - 2 ^ (-i / 12))
    fn lane(i, half, y) = (half * (i + 0.5) / pairs * u, y)
    fn peg(i) = (7.2 * u, nut_y + (12 + 24 * i / (pairs - 1)) * u)

    @color("#6b3a1e") solid body {
        v = path(
            from: (0, 0),
            bezier_to((32 * u, 0), (50 * u, 12 * u), (50 * u, 38 * u)),
            bezier_to((50 * u, 56 * u), (w, 60 * u), (w, 77 * u)),
            bezier_to((w, 91 * u), (37 * u, 92 * u), (37 * u, 106 * u)),
            bezier_to((37 * u, 121 * u), (24 * u, 128 * u), (0, 128 * u)),
            mirrored(about: y_axis)
        )
    }
    @color(bone) solid binding { v = offset(body.v, -1.2 * u) }
    @color("#8c4a22") solid burst { v = offset(body.v, -2.4 * u) }
    @color(darker(spruce, 0.25)) solid blend { v = offset(body.v, -6 * u) }
    @color(spruce) solid top { v = offset(body.v, -10.5 * u) }
    @color(darker(spruce, 0.14))
    drawing grain { v = hatching(top.v, pitch: 7 * u, angle: 90deg, margin: u) }
    @color("#7a3b22")
    solid guard { v = drop((15 * u, 73 * u), radius: 11 * u, height: 36 * u, angle: 155deg) }
    @color(red) solid rosette { v = circle(center: eye, radius: 17.5 * u) }
    @color(bone)
    solid inlay { v = polar_array(circle(radius: 0.8 * u), n: 36, radius: 15.7 * u, center: eye) }
    @color("#1d1513") solid sound { v = circle(center: eye, radius: 13.5 * u) }

    @color(ebony)
    solid board { v = trapezoid(bottom_width: 15 * u, top_width: 12 * u, height: nut_y - 94 * u) }
    @color("#d8d8d0") drawing wires {
        for i in 1..frets {
            if fret_y(i) > 95 * u {
                fret[i] = clip(line((-8 * u, fret_y(i)), (8 * u, fret_y(i))), by: board.v)
            }
        }
    }
    @color(ebony) solid bridge {
        block = rounded_rectangle(center: (0, 35 * u), width: 22 * u, height: 8 * u, radius: 2 * u)
        v = rhombus(center: (0, 35 * u), width: 44 * u, height: 9 * u)
    }
    @color(red) solid head {
        flare = trapezoid(bottom_width: 12 * u, top_width: 19 * u, height: 8 * u)
        blade = trapezoid(bottom_width: 19 * u, top_width: 22 * u, height: 33 * u)
        crest = dome(width: 22 * u, height: 4 * u)
        constrain column(crest, blade, flare, gap: 0, align: center)
    }
    @color(bone) solid bones {
        for i in [3, 5, 7, 9, 12] { dot[i] = circle(center: (0, fret_y(i - 0.5)), radius: 1.1 * u) }
        nut = rectangle(center: (0, nut_y + u), width: 12.4 * u, height: 2 * u)
        saddle = slot(center: (0, 36.5 * u), length: 17 * u, width: 1.2 * u)
    }
    @color("#d9d2c0") solid pegs {
        for i in 0..<pairs {
            stem[i] = rectangle(center: peg(i) + (5 * u, 0), width: 6 * u, height: 1.4 * u)
            key[i] = squircle(center: peg(i) + (10 * u, 0), width: 5 * u, height: 5.5 * u)
        }
    }
    other_pegs = mirror(pegs, about: y_axis)

    @color("#fffbe8") drawing right_strings {
        for i in 0..<pairs {
            string[i] = polyline(lane(i, 6.2, 33 * u), lane(i, 4.8, nut_y), peg(pairs - 1 - i))
        }
    }
    left_strings = mirror(right_strings, about: y_axis)

    constrain {
        board.below(bones.nut, gap: 0, align: center)
        head.on_top_of(bones.nut, align: center)
    }
}
