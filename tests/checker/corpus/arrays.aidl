/// Arrays of one and two indices, negative indices, lists that map, ranges that leave out the end.
assembly board {
    param rows = 3 in 2..5
    param columns = 4 in 2..6
    solid panel {
        sheet = rectangle(width: 12 * columns, height: 12 * rows)
        for i in 0..<rows {
            for j in 0..<columns {
                hole peg[i][j] { rim = circle(radius: 2) }
            }
        }
        constrain {
            for i in 0..<rows {
                for j in 0..<columns {
                    peg[i][j].center == sheet.bottom_left + (12 * j + 6, 12 * i + 6)
                }
            }
        }
    }
    drawing marks {
        for k in [1, 2, 5] { dot[k] = circle(center: (k * 10, -40 - k), radius: 1) }
        constrain {
            align_center_y(dot)
            dot[-1].center.x - dot[1].center.x == 33
            for d in dot { d.radius == 1 }
        }
    }
    constrain marks.below(panel, gap: sum([1, 2, 3]))
    assert len(panel.peg[0]) == columns
}
