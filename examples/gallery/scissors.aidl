/// A pair of scissors: two ground blades that turn about a screw, with handles for a thumb and for fingers.
assembly scissors {
    param reach = 110mm in 82..140
    param opening = 36deg in 14..50
    param blade = 20mm in 15..25
    param thumb = 34mm in 25..43
    param ribs = 5 in 3..7 step 1

    let red = "#d8392f"
    let steel = "#aab6c0"
    let low = 0.32 * reach
    let high = 1.12 * reach + 14
    let wide = 0.85 * reach
    @color(tint) solid sheet(tint = "#fdfbf3") {
        v = path(
            (-wide, low),
            polyline_to([(-7, low), (0, 0.6 * reach), (7, low), (wide, low), (wide, high)]),
            left(2 * wide),
            close()
        )
    }
    cast = sheet("#b5ada0") at (3, -4)
    paper = sheet()
    @color("#9db7cf")
    drawing rules { v = hatching(paper.v, pitch: 0.1 * reach, angle: 0deg, margin: 4) }
    @color("#d86a6a") drawing margin { v = line((-0.75 * wide, low), (-0.75 * wide, high)) }
    @dash(5, 3) drawing way { v = line((0, 0.62 * reach), (0, high)) }
    @color("#fdfbf3") solid chips {
        v = [equilateral_triangle((x, low - y), 6) for x, y in [[-14, 7], [9, 12], [20, 4]]]
    }
    assembly half(side = 1, eye = 34mm, long = 1) {
        let wide = eye / 2
        let tall = wide * long
        let x = side * (wide + 14)
        let y = -tall - 52
        @color(steel) solid body {
            edge = path(
                from: (-side * blade * 0.5, -14),
                line_to((-side * blade * 0.42, reach * 0.55)),
                bezier_to(
                    (-side * blade * 0.4, reach * 0.8), (-side * 3, reach * 0.95), (0, reach)
                ),
                line_to((side * blade * 0.5, 6)),
                line_to((side * blade * 0.5, -26)),
                line_to((side * blade * 0.05, -26)),
                close()
            )
        }
        @color("#eef2f5") solid ground {
            bevel = polygon((0, reach), (side * blade * 0.5, 6), (side * blade * 0.2, 14))
        }
        @color(red) solid handle {
            stem = strip(
                (side * blade * 0.25, -24),
                (x - side * wide * 0.5, y + tall * 0.75),
                blade * 0.9,
                15
            )
            collar = circle(center: (side * blade * 0.25, -24), diameter: blade * 0.9)
            ear = ellipse(center: (x, y), rx: wide + 8, ry: tall + 8)
            hole finger { v = ellipse(center: (x, y), rx: wide, ry: tall) }
        }
        @color(lighter(red, 0.45)) solid pad {
            rim = ellipse(center: (x, y), rx: wide + 3, ry: tall + 3)
            hole finger { v = ellipse(center: (x, y), rx: wide, ry: tall) }
        }
        @color(darker(red, 0.4)) drawing grip {
            for i in 0..<ribs {
                let a = 90deg - side * (60deg + 60deg / (ribs - 1) * i)
                rib[i] = line(
                    (x + (wide + 4) * cos(a), y + (tall + 4) * sin(a)),
                    (x + (wide + 7) * cos(a), y + (tall + 7) * sin(a))
                )
            }
        }
    }
    left = half(side: -1, eye: thumb + 2, long: 1.45) rotated -opening / 2
    right = half(side: 1, eye: thumb, long: 1.1) rotated opening / 2
    @color("#8b97a3") solid washer { rim = circle(center: origin, radius: 0.34 * blade) }
    @color("#5c6672") solid screw { head = circle(center: origin, radius: 0.26 * blade) }
    @color("#2c333c") solid groove {
        v = slot(center: origin, length: 0.4 * blade, width: 0.07 * blade, angle: 35deg)
    }
    constrain {
        concentric(screw.head, washer.rim)
        groove.centered_in(screw)
    }
}
