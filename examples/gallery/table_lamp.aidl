/// A leaded-glass table lamp: bulging panes, jewels along the rim, a turned stem, a pull chain, a table with a book.
assembly table_lamp {
    param shade_width = 130mm in 97..163
    param shade_height = 58mm in 43..73
    param stem_height = 74mm in 55..95
    param panes = 8 in 5..11 step 1
    param glass = "#e0a526" in ["#e0a526", "#4f9d8f", "#b5566b"]
    let s = shade_width / 2
    let h = shade_height
    let bronze = "#7a5230"
    let wide = max(4 * s, 230)
    @color(tint) @shade(light)
    solid part(w = 10, h = 4, r = 1, tint = bronze, light = "slope") {
        v = rounded_rectangle((0, 0), w, h, r)
    }
    /// The glass between two meridians of the shade, each a share of its half width.
    @color(lighter(tint, 0.35)) @shade(darker(tint, 0.1), 90deg)
    solid pane(a = 0, b = 1, tint = glass) {
        v = path(
            (a * s, 0),
            line_to((b * s, 0)),
            bezier_to((0.98 * b * s, 0.5 * h), (0.62 * b * s, 0.86 * h), (0.16 * b * s, h)),
            line_to((0.16 * a * s, h)),
            bezier_to((0.62 * a * s, 0.86 * h), (0.98 * a * s, 0.5 * h), (a * s, 0))
        )
    }
    @color("#c8352c") @shade(ball)
    solid jewel(width = 10) { v = ellipse(origin, 0.36 * width, 0.075 * h) }
    wall = part(wide, h + stem_height + 96, 0, "#413a58")
    @color("#534b6c") @shade("#2f2943") @stroke(none)
    solid paper { v = ribs(wall.v, pitch: 18, width: 8) }
    @color("#ffc765") @shade(fade) @opacity(0.8) @stroke(none) @clip(wall.v)
    solid halo { v = circle(radius: 1.7 * s) }
    @color("#fff3c4") @shade(fade, -90deg) @opacity(0.8) @stroke(none) solid glow {
        v = trapezoid(bottom_width: 3.4 * s, top_width: 1.84 * s, height: stem_height + 13)
    }
    table = part(wide, 10, 2, "#c08650")
    @color("#8a5c34") drawing grain { v = wood_grain(table.v, pitch: 3.5) }
    @color("#fff0c0") @shade(fade) @stroke(none) solid pool { v = ellipse((0, 0), 1.8 * s, 4.5) }
    front = part(wide - 12, 32, 1, "#8a5c3c")
    @color("black") @shade(fade, -90deg) @opacity(0.5) @stroke(none)
    solid ledge { v = rectangle((0, 0), wide - 12, 4) }
    drawer = part(120, 22, 2, "#a8754d")
    knob = part(9, 9, 4.5, "#d9b25f", "ball")
    foot = part(70, 6, 3, bronze, "round")
    @color(bronze) @shade(round) solid stem {
        v = path(
            (0, 0),
            right(30),
            bezier_to((22, 7), (9, 6), (7, 14)),
            bezier_to((5, 0.3 * stem_height), (14, 0.3 * stem_height), (12, 0.46 * stem_height)),
            bezier_to((10, 0.62 * stem_height), (4, 0.66 * stem_height), (4, 0.76 * stem_height)),
            vertical_to(stem_height),
            mirrored(about: y_axis)
        )
    }
    collar = part(18, 4, 2, "#a98a58", "round")
    socket = part(24, 8, 3, bronze, "round")
    assembly shade {
        for i in 0..<panes {
            let a = sin(180 * i / panes - 90)
            let b = sin(180 * (i + 1) / panes - 90)
            glass_[i] = pane(a, b, if i % 2 == 0 then glass else mix(glass, "#ffe9b0", 0.7))
            jewels[i] = jewel(s * (b - a)) at (0.49 * s * (a + b), 0.14 * h)
        }
        @color("#fff6d0") @shade(fade) @opacity(0.7) @stroke(none)
        solid shine { v = ellipse((0, 0.42 * h), 0.8 * s, 0.42 * h) }
    }
    rim = part(shade_width + 4, 5, 2.5, bronze, "round")
    cap = part(0.2 * shade_width, 5, 2, bronze, "round")
    @color("#a98a58") @shade(round) solid finial { v = drop(radius: 5, height: 17) }
    @color("#d0a862") @shade(slope) solid chain {
        for i in 0..8 { bead[i] = circle((0, -4.4 * i), radius: 1.7) }
        thread = rectangle((0, -18), 0.8, 36)
        bob = drop((0, -42), radius: 3, height: 11)
    }
    book = part(62, 11, 2, "#3f6f96")
    pages = part(58, 7, 1, "#fbf3df")
    other_book = part(52, 9, 2, "#a03f3f")
    other_pages = part(48, 5, 1, "#fbf3df")
    constrain {
        column(finial, cap, shade, rim, socket, collar, stem, foot, table, gap: -1, align: center)
        wall.above(table, gap: 0, align: center)
        halo.center == shade.center
        front.below(table, gap: 0, align: center)
        drawer.centered_in(front)
        knob.centered_in(drawer)
        ledge.top_center == front.top_center
        pool.center == table.center
        glow.above(table, gap: 0, align: center)
        chain.origin == rim.bottom_center + (0.36 * s, 0)
        book.bottom_right == table.top_right - (6, 0)
        centered_in(pages, book, by: (-2, 0))
        other_book.on_top_of(book, align: left)
        centered_in(other_pages, other_book, by: (2, 0))
    }
}
