/// A leaded-glass table lamp: bulging panes, jewels along the rim, a turned stem, a pull chain, a table with a book.
assembly table_lamp {
    param shade_width = 130mm in 97..163
    param shade_height = 58mm in 43..73
    param stem_height = 74mm in 55..95
    param panes = 8 in 5..11 step 1
    param glass = "#e0a526" in ["#e0a526", "#4f9d8f", "#b5566b"]
    let s = shade_width / 2
    let h = shade_height
    let bronze = "#6b4f35"
    @color(tint)
    solid part(w = 10, h = 4, r = 1, tint = bronze) { v = rounded_rectangle((0, 0), w, h, r) }
    /// The glass between two meridians of the shade, each a share of its half width.
    @color(tint) solid pane(a = 0, b = 1, tint = glass) {
        v = path(
            (a * s, 0),
            line_to((b * s, 0)),
            bezier_to((0.98 * b * s, 0.5 * h), (0.62 * b * s, 0.86 * h), (0.16 * b * s, h)),
            line_to((0.16 * a * s, h)),
            bezier_to((0.62 * a * s, 0.86 * h), (0.98 * a * s, 0.5 * h), (a * s, 0))
        )
    }
    @color("#b8322a") solid jewel(width = 10) { v = ellipse(origin, 0.34 * width, 0.075 * h) }
    wall = part(max(4 * s, 230), h + stem_height + 96, 0, "#4a4253")
    @color("#544b5e") @stroke(none) solid paper { v = ribs(wall.v, pitch: 18, width: 8) }
    @color("#8f7a55") @stroke(none) solid halo { v = circle((0, 0), 1.25 * s) }
    @color("#fff3c4") @opacity(0.85) @stroke(none) solid glow {
        v = trapezoid(bottom_width: 3.4 * s, top_width: 1.84 * s, height: stem_height + 13)
    }
    table = part(max(4 * s, 230), 10, 2, "#b07c4f")
    @color("#7d5330") drawing grain { v = wood_grain(table.v, pitch: 3) }
    front = part(max(4 * s, 230) - 12, 32, 1, "#8a5c3c")
    drawer = part(120, 22, 2, "#9c6b47")
    knob = part(9, 9, 4.5, "#d9b25f")
    foot = part(70, 6, 3)
    @color(bronze) solid stem {
        v = path(
            (0, 0),
            right(30),
            bezier_to((22, 7), (9, 6), (7, 14)),
            bezier_to((5, 0.3 * stem_height), (14, 0.3 * stem_height), (12, 0.46 * stem_height)),
            bezier_to((10, 0.62 * stem_height), (4, 0.66 * stem_height), (4, 0.76 * stem_height)),
            vertical_to(stem_height),
            mirrored(about: y_axis)
        )
        @color("#a98a63")
        drawing shine { v = arc((-7, 0.56 * stem_height), (-8, 0.38 * stem_height), radius: 18) }
    }
    collar = part(18, 4, 2, "#8a6a48")
    socket = part(24, 8, 3)
    assembly shade {
        for i in 0..<panes {
            let a = sin(180 * i / panes - 90)
            let b = sin(180 * (i + 1) / panes - 90)
            glass_[i] = pane(a, b, if i % 2 == 0 then glass else lighter(glass, 0.45))
            jewels[i] = jewel(s * (b - a)) at (0.49 * s * (a + b), 0.14 * h)
        }
    }
    rim = part(shade_width + 4, 5, 2.5)
    cap = part(0.2 * shade_width, 5, 2)
    @color(bronze) solid finial { v = drop(radius: 5, height: 17) }
    @color("#b08d57") solid chain {
        for i in 0..8 { bead[i] = circle((0, -4.4 * i), radius: 1.7) }
        thread = rectangle((0, -18), 0.8, 36)
        bob = drop((0, -42), radius: 3, height: 11)
    }
    book = part(62, 11, 2, "#3f5f7a")
    pages = part(58, 7, 1, "#fbf3df")
    other_book = part(52, 9, 2, "#8a3b3b")
    other_pages = part(48, 5, 1, "#fbf3df")
    constrain {
        column(finial, cap, shade, rim, socket, collar, stem, foot, table, gap: -1, align: center)
        wall.above(table, gap: 0, align: center)
        halo.center == shade.center
        front.below(table, gap: 0, align: center)
        drawer.centered_in(front)
        knob.centered_in(drawer)
        glow.above(table, gap: 0, align: center)
        chain.top == rim.bottom
        chain.center_x == stem.center_x + 0.36 * s
        book.on_top_of(table)
        align_right(book, table, inset: 6)
        centered_in(pages, book, by: (-3, 0))
        other_book.on_top_of(book, align: left)
        centered_in(other_pages, other_book, by: (3, 0))
    }
}
