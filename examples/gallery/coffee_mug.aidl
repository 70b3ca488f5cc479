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
    @color(tint) solid dish(radius = 10, tint = "white", flat = 0.24) {
        v = ellipse((0, 0), radius, flat * radius)
    }
    @color("#a9794f") solid table {
        board = rectangle((0, -14 * w), 236 * w, 84 * w)
        drawing d { v = planks(board, width: 21 * w, length: 130 * w) }
    }
    @color("black") @opacity(0.3) @stroke(none)
    solid cast { v = ellipse((6 * w, -8 * w), 106 * w, 27 * w) }
    underside = dish(104 * w, "#b9b2a3")
    saucer = dish(104 * w, "#f4efe4")
    @color(glaze) drawing ring_ { v = ellipse((0, 0), 96 * w, 22 * w) }
    well = dish(62 * w, "#ddd6c6")
    @color(glaze) solid handle {
        way = path(
            (46 * w, 82 * h), bezier_to((90 * w, 92 * h), (88 * w, 26 * h), (43 * w, 20 * h))
        )
        loop = thick(way, 12 * w)
        @color(lighter(glaze, 0.5))
        drawing shine { v = arc((77 * w, 52 * h), (66 * w, 79 * h), radius: 32 * w) }
    }
    @color(glaze) solid mug {
        body = path(
            (0, -9 * w),
            bezier_to((28 * w, -9 * w), (40 * w, -4 * w), (42 * w, 7 * h)),
            line_to((50 * w, 100 * h)),
            mirrored(about: y_axis)
        )
    }
    @color("#fdf8ec") solid spots {
        v = dots(mug.body, width / dots_across, 0.42 * width / dots_across, margin: 2 * w)
    }
    @color(darker(glaze, 0.3))
    solid foot { v = clip(rectangle((0, -8 * w), width, 22 * w), by: mug.body) }
    @color(lighter(glaze, 0.5)) drawing shine { v = line((-39.5 * w, 26 * h), (-43 * w, 66 * h)) }
    @color("black") @opacity(0.2) @stroke(none)
    solid side { v = difference(mug.body, copy(mug.body, by: (-13 * w, 0))) }
    lip = dish(51.5 * w, lighter(glaze, 0.25), flat: 0.26)
    inside = dish(46.5 * w, darker(glaze, 0.5), flat: 0.25)
    coffee = dish(45 * w, "#5a3420", flat: 0.23)
    foam = dish(36 * w, "#a9713f", flat: 0.2)
    @color("#fdf3df") solid milk { v = heart((0, 0), width: 36 * w, height: 11 * w) }
    @color("silver") solid spoon {
        bowl = ellipse((0, 0), 13 * w, 5.6 * w, angle: 12)
        shaft = strip((-10 * w, -2 * w), (-62 * w, -11 * w), 3.4 * w, 2 * w)
    }
    cookie_edge = dish(20 * w, "#9c6b3a", flat: 0.42)
    cookie = dish(20 * w, "#d29b5a", flat: 0.42)
    @color("#4a2b1a") solid chips {
        v = [ellipse((x * w, y * w), 2.6 * w, 1.6 * w) for x, y in [
            [-9, 2], [0, 5], [8, 1], [-3, -3], [4, -5]
        ]]
    }
    @color("#9aa7b3") @detached drawing steam {
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
