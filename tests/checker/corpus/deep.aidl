/// Five levels: constraints reach through, and each level keeps its own.
assembly ship {
    solid hull {
        side = trapezoid(bottom_width: 80, top_width: 120, height: 30)
        solid cabin {
            walls = rectangle(width: 40, height: 20)
            hole window {
                pane = rectangle(width: 12, height: 8)
                solid bar {
                    strip = rectangle(width: 1.5, height: guess(5))
                    constrain strip.height >= 2
                }
                constrain { bar.centered_horizontally(pane), bar.height == pane.height }
            }
            constrain window.centered_in(walls)
        }
        constrain cabin.stacked_on(side)
    }
    drawing sea { surface = line((-100, -10), (100, -10)) }
    constrain {
        sea.surface.start.y == hull.side.center.y
        hull.cabin.window.center_x == sea.center_x
        horizontal(sea.surface)
    }
}
