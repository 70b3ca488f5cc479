/// Many things in order: flush, in rows and columns, evenly spaced; and of one size or a little more.
// changes: book[0], house, post, shed, tower
drawing lined_up {
    page  = rectangle(center: fixed((0, 0)), width: 200, height: 160)
    title = rectangle(center: (5, 60), width: 80, height: 8)
    date  = rectangle(center: (60, 66), width: 20, height: 6)
    logo  = circle(center: (-60, 62), radius: 6)
    foot  = circle(center: (30, -60), radius: 3)
    lead  = rectangle(center: (9, 30), width: 60, height: 5)
    for i in 0..3 { book[i] = rectangle(center: (400 + 14 * i, i), width: 8 + 2 * i, height: 30 + 3 * i) }
    for i in 0..2 { jar[i] = circle(center: (400 + 30 * i, 80 + i), radius: 5 + i) }
    for i in 0..2 { brick[i] = rectangle(center: (400 + i, 160 - 12 * i), width: 20, height: 6) }
    for i in 0..2 { tile[i] = square(center: (460 + i, 160 - 20 * i), size: 8) }
    for i in 0..4 { peg[i] = circle(center: (600 + 20 * i + 2 * i * i, 0), radius: 2 + i) }
    for i in 0..2 { rung[i] = line((600, 40 + 11 * i), (630, 40 + 11 * i)) }
    for i in 0..3 { dot[i] = circle(center: (700 - i, 50 - 13 * i), radius: 2) }
    house = rectangle(center: (0, 300), width: 40, height: 30)
    tower = rectangle(center: (60, 300), width: 12, height: 20)
    shed  = rectangle(center: (100, 300), width: 20, height: 40)
    post  = rectangle(center: (130, 300), width: 60, height: 30)
    constrain {
        align_left(title, lead, page, inset: 10)
        flush(date, page, side: right, by: -10)
        align_top(logo, title, page, inset: 6)
        align_bottom(foot, page, inset: 4)
        align_center_x(logo, date, by: -150)
        align_center_y(date, title)
        row(book, gap: 2, align: bottom)
        same_height(book[0], book[1])
        row(jar, pitch: 40, align: center)
        row(brick[0], tile[0], at_least: 20)
        column(brick, gap: 3, align: left)
        column(tile, pitch: 25, align: right)
        evenly_spaced(peg)
        peg[0].center == (600, 0)
        peg[4].center == (700, 0)
        evenly_spaced(rung, spacing: 9, axis: y)
        evenly_spaced(dot, pitch: 15)
        same_width(tower, post)
        taller(tower, house, by: 20)
        shorter(shed, house, by: 12)
        wider(house, shed, at_least: 24)
        narrower(post, house, by: 30)
        larger(house, shed)
        smaller(shed, house, at_least: 5)
        same_size(jar[0], jar[0])
    }
}
