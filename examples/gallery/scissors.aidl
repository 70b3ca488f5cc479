/// A pair of scissors on a cutting mat: two ground blades that turn about a screw, handles for a thumb and for fingers.
assembly scissors {
    param reach = 110mm in 82..140
    param opening = 36deg in 14..50
    param blade = 20mm in 15..25
    param thumb = 34mm in 25..43
    param ribs = 5 in 3..7 step 1
    let red = "#d8392f"
    let low = 0.32 * reach
    let high = 1.12 * reach + 14
    let wide = 0.85 * reach
    let drop = (5, -6)
    @color("#2f7a70") @shade("#1d5650") solid mat {
        let half = max(wide + 16, 58 + 1.3 * thumb)
        v = rectangle(left: -half, right: half, bottom: -70 - 1.45 * thumb, top: high + 16)
        fillet(v.corners, 8)
    }
    @color("#7fb8ae") @opacity(0.45) @stroke(0.3) drawing grid {
        squares = crosshatch(mat.v, pitch: 14, angle: 0deg, margin: 6)
        border = offset(mat.v, -6)
    }
    @color(tint) @stroke(none) solid sheet(tint = "#fdfbf3") {
        v = path(
            (-wide, low),
            polyline_to([(-7, low), (0, 0.6 * reach), (7, low), (wide, low), (wide, high)]),
            left(2 * wide),
            close()
        )
    }
    @opacity(0.3) under = sheet("black") at (3, -4)
    @shade("#e9e2d0", -45deg) paper = sheet()
    @color("#9db7cf")
    drawing rules { v = hatching(paper.v, pitch: 0.1 * reach, angle: 0deg, margin: 4) }
    @color("#d86a6a") drawing margin { v = line((-0.75 * wide, low), (-0.75 * wide, high)) }
    @dash(5, 3) drawing way { v = line((0, 0.62 * reach), (0, high)) }
    assembly half(side = 1, eye = 34mm, long = 1) {
        let b = side * blade / 2
        let wide = eye / 2
        let tall = wide * long
        let middle = (side * (wide + 14), -tall - 52)
        let root = (0.5 * b, -24)
        @color("#c3ced6") @shade("#74828e", -20deg) solid body {
            edge = path(
                from: (-b, -14),
                line_to((-0.84 * b, 0.55 * reach)),
                bezier_to((-0.8 * b, 0.8 * reach), (-0.3 * b, 0.95 * reach), (0, reach)),
                polyline_to([(b, 6), (b, -26), (0.1 * b, -26)]),
                close()
            )
        }
        @color("#fbfdff") @shade("#b9c5ce")
        solid ground { bevel = polygon((0, reach), (b, 6), (0.4 * b, 14)) }
        if side == 1 {
            @color("#53616d") drawing maker {
                v = text("AIDL", (-0.33 * b, 0.36 * reach), 0.24 * blade, angle: 91deg, bold: true)
            }
        }
        @color(red) @shade(darker(red, 0.45), -40deg) solid handle {
            stem = strip(root, middle + (-side * wide / 2, 0.75 * tall), 0.9 * blade, 15)
            collar = circle(root, diameter: 0.9 * blade)
            ear = ellipse(middle, wide + 9, tall + 9)
            hole finger { v = ellipse(middle, wide, tall) }
        }
        @color("#37393f") @shade(slope) solid pad {
            rim = ellipse(middle, wide + 3, tall + 3)
            hole finger { v = ellipse(middle, wide, tall) }
        }
        @color("white") @opacity(0.4) @stroke(none) solid gleam {
            lit = ellipse(middle, wide + 8, tall + 8)
            hole rest { v = ellipse(middle + (1.6, -1.6), wide + 8, tall + 8) }
        }
        @color(darker(red, 0.5)) drawing grip {
            for i in 0..<ribs {
                let a = 90deg - side * (60deg + 60deg / (ribs - 1) * i)
                let rim = (wide * cos(a), tall * sin(a))
                rib[i] = line(middle + 1.26 * rim, middle + 1.44 * rim)
            }
        }
    }
    left = half(side: -1, eye: thumb + 2, long: 1.45) rotated -opening / 2
    right = half(side: 1, eye: thumb, long: 1.1) rotated opening / 2
    @color("black") @opacity(0.3) @stroke(none) @behind(left) solid cast {
        for i, h in enumerate([left, right]) {
            blade[i] = copy(h.body.edge, by: drop)
            collar[i] = copy(h.handle.collar, by: drop)
            stem[i] = copy(h.handle.stem, by: drop)
            eye[i] = difference(copy(h.handle.ear, by: drop), copy(h.handle.finger.v, by: drop))
        }
    }
    @color("#dbe2e7") @shade(ball)
    solid washer { rim = circle(center: origin, radius: 0.36 * blade) }
    @color("#aab5be") @shade(slope, -45deg) solid screw { head = circle(origin, 0.27 * blade) }
    @color("#2c333c") solid groove {
        v = slot(center: origin, length: 0.42 * blade, width: 0.07 * blade, angle: 35deg)
    }
    constrain {
        concentric(screw.head, washer.rim)
        groove.centered_in(screw)
    }
}
