/// Every relation of boxes, on structures.
// changes: right_leg.board
assembly desk {
    solid top { board = rectangle(width: 120, height: 4) }
    solid left_leg { board = rectangle(width: 4, height: 70) }
    solid right_leg { board = rectangle(width: 5, height: 68) }
    solid drawer { front = rectangle(width: 30, height: 12) }
    solid lamp { shade = trapezoid(bottom_width: 20, top_width: 10, height: 15) }
    solid cup { body = circle(radius: 4) }
    solid book { cover = rectangle(width: 14, height: 20) }
    solid floor { board = rectangle(center: (0, -80), width: fixed(200), height: 2) }
    constrain {
        top.above(left_leg, gap: 0)
        align_left(left_leg, top, inset: 3)
        same_height(right_leg, left_leg)
        align_bottom(right_leg, left_leg)
        align_right(right_leg, top, inset: 3)
        drawer.below(top, gap: 1)
        centered_horizontally(drawer, top)
        lamp.on_top_of(top, align: "left")
        cup.stacked_on(top)
        book.on_top_of(top, align: "right")
        left_leg.on_top_of(floor)
        floor.wider(top)
        cup.narrower(book)
        left_leg.taller(lamp)
        cup.shorter(book)
        no_overlap(lamp, cup)
    }
}
