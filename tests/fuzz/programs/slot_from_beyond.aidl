solid s { a = slot(start: (1e308, 30), end: (0.3, 60), width: 6) }
