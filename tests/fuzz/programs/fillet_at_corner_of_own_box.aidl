solid plate { fillet(plate.top_left, 5) }
