solid s { c = circle(center: (1e308m, 0), radius: 1) }
