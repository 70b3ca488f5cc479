for s in [-1, 1e29] { hole adjust[s] {} clearance(adjust[1]) }
