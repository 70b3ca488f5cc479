/// Sides of boxes with gaps, minimum gaps and a line-up across; between, beside and apart.
assembly sides {
    solid table  { top = rectangle(center: (0, 0), width: 120, height: 10) }
    solid lamp   { foot = rectangle(center: (30, 40), width: 12, height: 30) }
    solid clock  { case = circle(center: (-20, 40), radius: 9) }
    solid book   { cover = rectangle(center: (2, 30), width: 20, height: 4) }
    solid rug    { cloth = rectangle(center: (4, -30), width: 80, height: 3) }
    solid cat    { body = ellipse(center: (-90, 2), rx: 14, ry: 8) }
    solid dog    { body = ellipse(center: (95, 1), rx: 18, ry: 10) }
    solid shelf  { board = rectangle(center: (3, 90), width: 60, height: 5) }
    solid vase   { body = circle(center: (2, 70), radius: 6) }
    solid door   { leaf = rectangle(center: (200, 0), width: 30, height: 80) }
    solid window { pane = rectangle(center: (330, 0), width: 30, height: 40) }
    solid mirror_ { glass = ellipse(center: (240, 10), rx: 8, ry: 14) }
    solid box_[1] { walls = rectangle(center: (500, 0), width: 20, height: 20) }
    solid box_[2] { walls = rectangle(center: (506, 4), width: 20, height: 20) }
    solid box_[3] { walls = rectangle(center: (494, 9), width: 20, height: 20) }
    constrain {
        on_top_of(lamp, table)
        on_top_of(clock, table, align: right)
        stacked_on(book, rug)
        rug.below(table, gap: 20, align: left)
        beside(cat, table, gap: 3, align: center)
        beside(dog, table, at_least: 5, align: bottom)
        shelf.above(table, at_least: 60, align: center)
        centered_between(vase, table, shelf)
        vase.centered_horizontally(table, by: 4)
        window.right_of(door, at_least: 90, align: top)
        mirror_.left_of(window, at_least: 20)
        centered_between(mirror_, door, window, axis: x)
        centered_vertically(mirror_, door, by: -5)
        no_overlap(box_, at_least: 2)
        touching(book, rug)
        overlapping(mirror_, mirror_)
    }
}
