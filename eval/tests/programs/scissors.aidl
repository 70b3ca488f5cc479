/// A pair of scissors, opened: two halves that cross at a pivot.
assembly scissors {
    solid half(length = 100) {
        blade = triangle(a: (-6, 0), b: (6, 0), c: (0, length))
        shank = rectangle(center: (0, -20), width: 10, height: 45)
        handle = ring(center: (0, -60), outer_radius: 22, inner_radius: 14)
        constrain {
            shank.top.midpoint == blade.ab.midpoint
            handle.outer.center == shank.bottom.midpoint - (0, 18)
        }
    }
    left = half() rotated 18deg
    right = half() rotated -18deg

    solid pivot { screw = circle(radius: 4) }
    constrain {
        left.blade.ab.midpoint == pivot.screw.center
        right.blade.ab.midpoint == pivot.screw.center
    }
}
