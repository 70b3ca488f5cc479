/// Names that are also words of the language; members hide sides of boxes.
solid body {
    line = line((0, 0), (10, 0))
    circle = circle(center: (5, 5), radius: 2)
    top = (0, 30)
    hole hole { left = circle(center: (4, 4), radius: 1) }
    solid solid { body = rectangle(width: 4, height: 4) }
    constrain {
        self.top.y == 25
        hole.left.center == circle.center
        solid.center == line.midpoint
        hole.right - hole.left.center.x == 1
        circle.bottom == line.start.y + 4
    }
}
