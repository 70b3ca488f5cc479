/// Dimensions by hand: they hold whatever comes of the constraints.
solid dimensioned {
    body = rectangle(center: (0, 0), width: 80, height: 50)
    hole eye { rim = circle(center: (-15, 5), diameter: 20) }
    constrain {
        eye.rim.center == body.bottom_left + (25, 30)
        dimension(body.left, eye.rim.center, offset: 40, tolerance: 0.1)
        dimension(eye.rim, fit: "H7")
    }
}
