assembly a { solid disc(d = 4) { c = circle(diameter: d) } left = disc() at (1e308, 0) }
