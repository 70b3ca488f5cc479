/// Constraints held by a turned structure speak of boxes and coordinates in its own frame.
// changes: panel.window.pane
assembly wall {
    solid panel at (20, 10) rotated 35deg {
        sheet = rectangle(width: 80, height: 40)
        hole window at (-10, 0) rotated 10deg {
            pane = ellipse(rx: 8, ry: 4, angle: 20deg)
        }
        hole lock {
            bow = arc(center: (0, 0), radius: 5, start_angle: 40deg, end_angle: 260deg)
            bar = line(bow.end, bow.start)
        }
        drawing wave rotated -50deg {
            curve = bezier((0, 0), (5, 12), (20, -10), (25, 0))
        }
        constrain {
            window.left_of(lock, gap: 4)
            window.align_top(lock)
            lock.bow.center.y == sheet.center.y
            wave.below(window, gap: 2)
            wave.left == window.left
            lock.bar.start.x == sheet.center.x + 12
        }
    }
    solid post { board = rectangle(width: 6, height: 90) }
    for i in 0..2 {
        solid lamp[i] at (30 * i, -60) rotated 20deg * i {
            bulb = regular_polygon(radius: 6, sides: 3 + i)
            dot  = (3, 0)
        }
    }
    constrain {
        post.left_of(panel, gap: 3)
        post.bottom == panel.bottom
        panel.window.pane.center.y >= panel.sheet.center.y
        row(lamp, gap: 5, align: "bottom")
        lamp[0].below(panel, gap: 10)
        lamp[1].dot.x == panel.lock.bow.center.x
    }
}
