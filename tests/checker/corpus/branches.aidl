/// `if` at build time, conditional expressions, named choices, empty ranges.
solid knob {
    param style = "round" in ["round", "square"]
    param teeth = 0 in 0..20
    param large = true in [true, false]
    let size = if large then 30 else 20
    if style == "round" {
        body = circle(radius: size / 2)
    } else {
        body = square(size: size)
    }
    for i in 0..<teeth {
        hole tooth[i] { cut = circle(center: fixed(polar(size / 2, 360deg / teeth * i)), radius: 1) }
    }
    mark = line(origin, (0, size / 3 if large else 5))
    constrain {
        if style == "round" { mark.start == body.center } else { mark.start == body.bottom.midpoint }
        vertical(mark)
        mark.length == (if large then 12 else 4)
    }
}
