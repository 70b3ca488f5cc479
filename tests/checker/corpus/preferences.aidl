/// Soft constraints give way to hard ones.
solid plate {
    edge = rectangle(center: origin, width: guess(50), height: guess(30))
    hole bore { rim = circle(center: (3, 3), radius: 5) }
    constrain {
        edge.width >= 40
        edge.width <= 60
        edge.height == edge.width / 2
        prefer edge.width == 100
        prefer bore.rim.center == (0, 0) weight 3
        bore.rim.center.x >= 4
    }
}
