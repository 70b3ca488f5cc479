solid s { p = path(from: (0, 0), [forward(20, turn: 60deg) for i in 1..4000], close()) }
