solid s { g = gear(teeth: 12000, module: 2) }
