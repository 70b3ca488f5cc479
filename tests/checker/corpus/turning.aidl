/// Rectangles that may turn, rectangles that are turned.
solid cards {
    table = rectangle(center: origin, width: fixed(200), height: fixed(100))
    a = rectangle(center: (-40, 0), width: 30, height: 20, rotatable: true)
    b = rectangle(center: (40, 0), width: 30, height: 20, angle: 25deg)
    constrain {
        a.bottom.angle == 40
        a.bottom_left == (-50, -20)
        b.top_right == (60, 20)
        b.width == 30
    }
}
