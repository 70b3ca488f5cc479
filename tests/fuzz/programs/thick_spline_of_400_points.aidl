solid s { p = spline([(i * 3, 10 * sin(i * 30deg)) for i in 0..400]) t = thick(p, 2) }
