/// A spur gear with a bore and four mounting holes on a circle.
@thickness(5mm)
solid plate_gear {
    param teeth = 24 in 12..60
    body = gear(teeth: teeth, module: 3)
    hole bore { rim = circle(center: origin, radius: 8) }
    for i in 0..3 {
        hole mounting_hole[i] { rim = circle(center: fixed(polar(22, 90deg * i)), diameter: 5) }
    }
    constrain bore.rim.center == body.center
}
