/// A street lamp with one lantern.
assembly street_lamp {
    param height = 300 in 240..360

    solid base { foot = trapezoid(bottom_center: origin, bottom_width: 50, top_width: 26, height: 30) }
    solid post { pole = rectangle(center: (0, 0.5 * height), width: 12, height: height) }
    solid lantern {
        glass = trapezoid(bottom_center: (0, height), bottom_width: 30, top_width: 56, height: 60)
        cap = triangle(bottom_center: (0, height + 60), base: 70, height: 24)
    }
}
