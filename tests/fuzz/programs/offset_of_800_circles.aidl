solid s { for i in 0..800 { c[i] = circle(center: (i * 3, 0), radius: 1) } o = offset(union(c), 1.6) }
