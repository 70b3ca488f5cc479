/// A panelled door with four panels and a handle.
assembly door {
    @color("peru")
    solid leaf {
        slab = rectangle(width: 80, height: 200)
        for row in 0..1 {
            for column in 0..1 {
                hole panel[row][column] {
                    field = rectangle(
                        center: (36 * column - 18, 90 * row - 45), width: 26, height: 75
                    )
                    solid raised {
                        field = rectangle(
                            center: (36 * column - 18, 90 * row - 45), width: 20, height: 69
                        )
                    }
                    constrain raised.centered_in(field)
                }
            }
        }
    }
    @color("gold")
    solid handle {
        rose = circle(radius: 3)
        lever = slot(start: (0, 0), end: (-12, 0), width: 3)
        constrain lever.start == rose.center
    }
    constrain {
        handle.rose.center == leaf.slab.right.midpoint - (6, 0)
    }
}
