/// Records, texts, lists and loops: what the program says before anything is solved.
assembly values {
    let sizes = record(small: 4mm, large: 9mm, places: [10, 30, 60])
    let names = ["a", "b"] + ["c"]
    let columns = [1, 2] + [i + 3 for i in range(0, 4, 2)]
    fn width_of(size: text) = sizes[size]
    fn width_of(size: length) = 2 * size
    fn width_of(point_: point) = point_.x + point_.y
    fn width_of(c: circle) = c.diameter
    fn width_of(things: list) = sum([width_of(t) for t in things])
    fn card(width: length, height: length, corner_radius: length = 1) =
        rounded_rectangle(width: width, height: height, radius: corner_radius)
    shape pad(center: point = (0, 0), size: length) {
        rim = circle(center: center, radius: size / 2)
        let reach = size + 1
    }
    shape pad(center: point = (0, 0), text, size: length = 6) {
        rim = circle(center: center, radius: if text == "big" then size else size / 3)
        let reach = size + 2
    }
    solid row_ {
        for i, x in enumerate(sizes.places) { peg[i] = circle(center: (x, 3 * i), r: 3) }
        for name, at_ in zip(names, sizes.places) {
            hole slot_[round(at_)] { cut = circle(center: (at_, 20), dia: if name == "b" then 4 else 2) }
        }
        for i in 0..40 step 20 { tick[i] = circle(center: (i, 40), radius: 1) }
        tag = card(w: 12, h: 7, fillet: 2)
        dot = pad(size: 8)
        spot = pad((70, 70), "big")
        constrain {
            for i, x in enumerate(sizes.places) { peg[i].center.x == x + 1 }
            for p, q in zip([0, 1], [1, 2]) { peg[q].center.y - peg[p].center.y == 4 * q }
            tick[20].center.y == width_of("large")
            tick[40].center.x - tick[0].center.x == width_of(sizes.large) + width_of((3, 4))
            tag.width == width_of([peg[0], peg[1]])
            dot.reach == 9
            spot.reach == spot.rim.diameter - 4
            len(columns) == 4
        }
    }
    constrain row_.left == sizes["small"]
    assert "tag" + str(4) == "tag4" and columns[3] == 5 and names[-1] == "c"
}
