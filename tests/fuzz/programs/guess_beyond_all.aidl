fn big(x) = x * x solid s { c = circle(center: (big(1e14), 0), radius: 1) }
