/// A door key: a round bow with a hole, a shank, and a bit whose cuts are listed from the tip.
solid key {
    param shank_length = 40mm in 32..60
    param pitch = 5mm in 3..6

    let cuts = [3, 5.5, 2, 4.5, 3.5]  // depth of each cut from the back of the blade

    bow = circle(radius: 13)
    shank = rectangle(width: shank_length, height: 9)

    hole eye {
        rim = circle(diameter: 7)
    }

    // Each cut takes a notch out of the lower edge.
    for i in 0..<len(cuts) {
        hole notch[i] {
            v = triangle(a: (-3.3, -2), b: (3.3, -2), c: (0, 4))
        }
        constrain {
            notch[i].center_x == shank.bb.right - pitch * (i + 0.8)
            notch[i].top == shank.bb.bottom + 0.8 * cuts[i]
        }
    }

    // A groove along the blade.
    drawing groove {
        upper = line((0, 2), guess((30, 2)))
    }

    // The point of the key.
    point_top = line(shank.top_right, (50, 1))
    point_bottom = line(point_top.end, shank.bottom_right)

    constrain {
        shank.left.midpoint == bow.center + (12, 0)
        eye.rim.center == bow.center - (6, 0)
        point_top.end == shank.right.midpoint + (4, 0)
        groove.upper.start == shank.bottom_left + (4, 7)
        groove.upper.end.x == shank.top_right.x
        horizontal(groove.upper)
    }

    assert len(cuts) * pitch + 2 <= shank_length, "the cuts do not fit on the blade"
}
