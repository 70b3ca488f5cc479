/// A rocket with two fins.
assembly space_rocket {
    param height = 160 in 120..200

    solid nozzle { bell = trapezoid(center: (0, -0.5 * height - 10), bottom_width: 34, top_width: 22, height: 20) }
    solid left_fin { blade = polygon([(-28, -30), (-28, -0.5 * height), (-62, -0.5 * height - 16)]) }
    right_fin = mirror(left_fin, about: y_axis)
    solid body { tube = rectangle(center: origin, width: 60, height: height) }
    solid nose { tip = triangle(bottom_center: (0, 0.5 * height), base: 60, height: 60) }
    solid window {
        frame = circle(center: (0, 30), radius: 15)
        hole glass { rim = circle(center: (0, 30), radius: 10) }
    }
}
