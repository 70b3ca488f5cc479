/// A dotted mug of coffee on its saucer, seen a little from above: a heart of milk, a spoon, a cookie, and steam.
assembly coffee_mug {
    param width = 78mm in 58..98
    param height = 80mm in 60..100
    param dots_across = 5 in 3..7 step 1
    param wisps_of_steam = 3 in 2..5 step 1
    param glaze = "#3a7d8c" in ["#3a7d8c", "#c0504d", "#e0a030"]
    let w = width / 100
    let h = height / 100
    /// A round thing lying flat.
    @color(tint) @shade(slope, -50deg)
    solid dish(radius = 10, tint = "white", flat = 0.24) {
        v = ellipse((0, 0), radius, flat * radius)
    }
    @color("#f3e3c8") @shade("#b98f63", 0deg) solid wall {
        v = rectangle(left: -128 * w, right: 128 * w, bottom: 20 * w, top: 100 * h + 62)
    }
    @color("#b98252") @shade(slope) solid table {
        board = rectangle(left: -128 * w, right: 128 * w, bottom: -58 * w, top: 28 * w)
        @stroke(0.25 * w) drawing d { v = planks(board, width: 21.5 * w, length: 130 * w) }
    }
    @color("#2a1405") @shade(fade) @stroke(none) @clip(table.board)
    solid cast { v = ellipse((10 * w, -12 * w), 156 * w, 46 * w) }
    underside = dish(104 * w, "#b9b2a3")
    saucer = dish(104 * w, "#f4efe4")
    @color(glaze) drawing ring_ { v = ellipse((0, 0), 96 * w, 22 * w) }
    well = dish(62 * w, "#ddd6c6")
    @color("#2a1405") @shade(fade) @opacity(0.7) @stroke(none)
    solid mug_shadow { v = ellipse((14 * w, -3 * w), 66 * w, 14 * w) }
    @color(glaze) @shade(slope, -60deg) solid handle {
        way = path(
            (46 * w, 82 * h), bezier_to((90 * w, 92 * h), (88 * w, 26 * h), (43 * w, 20 * h))
        )
        loop = thick(way, 12 * w)
        @color(lighter(glaze, 0.5))
        drawing shine { v = arc((77 * w, 52 * h), (66 * w, 79 * h), radius: 32 * w) }
    }
    @color(glaze) @shade(round) solid mug {
        body = path(
            (0, -9 * w),
            bezier_to((28 * w, -9 * w), (40 * w, -4 * w), (42 * w, 7 * h)),
            line_to((50 * w, 100 * h)),
            mirrored(about: y_axis)
        )
    }
    @color("#fdf8ec") @shade(round) @stroke(none) solid spots {
        v = dots(mug.body, width / dots_across, 0.42 * width / dots_across, margin: 2 * w)
    }
    @color(darker(glaze, 0.3)) @shade(round)
    solid foot {
        v = difference(
            mug.body,
            hull(ellipse((0, 8 * w), 46 * w, 11 * w), ellipse((0, 100 * h), 60 * w, 11 * w))
        )
    }
    @color(lighter(glaze, 0.5)) drawing shine { v = line((-39.5 * w, 26 * h), (-43 * w, 66 * h)) }
    lip = dish(51.5 * w, lighter(glaze, 0.25), flat: 0.26)
    inside = dish(46.5 * w, darker(glaze, 0.5), flat: 0.25)
    coffee = dish(45 * w, "#5a3420", flat: 0.23)
    foam = dish(36 * w, "#a9713f", flat: 0.2)
    @color("#fdf3df") solid milk { v = heart((0, 0), width: 36 * w, height: 11 * w) }
    @color("silver") @shade(ball) solid spoon {
        bowl = ellipse((0, 0), 13 * w, 5.6 * w, angle: 12)
        drawing hollow { v = ellipse((0, 0), 10 * w, 3.8 * w, angle: 12) }
        shaft = strip((-10 * w, -2 * w), (-62 * w, -11 * w), 3.4 * w, 2 * w)
    }
    cookie_edge = dish(20 * w, "#9c6b3a", flat: 0.42)
    cookie = dish(20 * w, "#d29b5a", flat: 0.42)
    @color("#4a2b1a") solid chips {
        v = [ellipse((x * w, y * w), 2.6 * w, 1.6 * w) for x, y in [
            [-9, 2], [0, 5], [8, 1], [-3, -3], [4, -5]
        ]]
    }
    @color("white") @opacity(0.55) @stroke(2.6 * w) @detached drawing steam {
        v = [wave((12 * i, 0), (12 * i + 4, 44), 4, 1.5) for i in 0..<wisps_of_steam]
    }
    constrain {
        underside.center == saucer.center - (0, 4 * w)
        lip.center == (0, 100 * h)
        centered_in(inside, lip, by: (0, -0.5 * w))
        centered_in(coffee, lip, by: (0, -1.4 * w))
        foam.centered_in(coffee)
        milk.centered_in(foam)
        spoon.center == saucer.center + (48 * w, -14 * w)
        cookie.center == saucer.center + (-70 * w, 2 * w)
        cookie_edge.center == cookie.center - (0, 3 * w)
        chips.center == cookie.center
        steam.above(lip, gap: -4)
        centered_horizontally(steam, lip)
    }
}
