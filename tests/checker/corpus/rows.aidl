/// Rows, columns, even spacing and groups.
// changes: box[0].edge, pin[0]
assembly tray {
    for i in 0..3 {
        solid cup[i] { rim = circle(center: (10 * i, i), radius: 3 + i) }
    }
    for i in 0..2 {
        solid box[i] { edge = rectangle(center: (i, 12 * i), width: 6 + i, height: 5) }
    }
    pin[0] = circle(center: (0, -30), radius: 2)
    pin[1] = circle(center: (13, -31), radius: 3)
    pin[4] = circle(center: (40, -29), radius: 1)
    solid lid { cover = rectangle(width: 30, height: 3) }
    constrain {
        row(cup, gap: 4, align: "bottom")
        column(box[2], box[1], box[0], gap: 1.5, align: "left")
        evenly_spaced(pin, axis: x)
        horizontal([p.center for p in pin])
        lid.above(cup, gap: 2)
        centered_horizontally(lid, cup)
        box.left_of(cup, gap: 10)
        same_size(box[0], box[1])
        equal_radius(pin[0], pin[4])
    }
    assert len(pin) == 3 and len(cup) == 4, "sparse arrays count their members"
}
