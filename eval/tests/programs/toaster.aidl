/// A toaster with two slices.
assembly toaster {
    param width = 160 in 130..200

    for i in 0..1 {
        solid toast[i] { slice = rounded_rectangle(center: fixed((width * (i - 0.5) / 2.2, 55)), width: 50, height: 50, radius: 10) }
        solid foot[i] { pad = rectangle(center: fixed((width * (i - 0.5) / 1.5, -54)), width: 20, height: 8) }
    }
    solid body { case = rounded_rectangle(center: origin, width: width, height: 100, radius: 14) }
    solid lever { knob = rounded_rectangle(center: fixed((width / 2 + 6, 10)), width: 14, height: 8, radius: 2) }
}
