drawing d { a = triangle(ab: 10, bc: 20, ca: 40) }
