/// Copies of geometry and of structures: mirrored, moved, turned and scaled, and statements that edit.
// changes: wing.body.points[1]
assembly copies {
    solid wing {
        construction hinge = line((0, -10), (0, 30))
        body = polygon((2, 0), (30, 4), (24, 20), (3, 16))
        curve = arc(center: (10, 40), radius: 6, start_angle: 10deg, end_angle: 200deg)
        chord = line(curve.end, curve.start)
        hole eye { rim = circle(center: (15, 10), radius: 3) }
        fillet(body.corner[1], 2)
        twin = mirror(body, about: hinge)
        bent = mirror(curve, about: hinge)
        lid = mirror(chord, about: hinge)
        constrain {
            vertical(hinge)
            body.edges[0].length == 30
            eye.rim.center == body.bb.center
        }
    }
    other = mirror(wing, about: line((60, 0), (60, 1)))
    third = copy(wing, by: (0, 100), angle: 30deg)
    drawing flags {
        flag = triangle(a: (200, 0), b: (200, 16), c: (222, 8))
        second = copy(flag, by: (30, 0))
        tilted = copy(flag, by: (60, 0), angle: -30deg)
        small = copy(flag, by: (90, 0), scale: 0.5)
        moved = move(flag, by: (0, 40))
        turned_ = rotate(flag, 45deg, about: (200, 60))
        large = scale(flag, 2, about: (200, -50))
        hand = rectangle(center: (300, 10), width: 2, height: 20)
        rotate(hand, -60deg, about: (300, 0))
        stone = rectangle(center: (300, 100), width: 20, height: 6)
        move(stone, (0, 3))
        constrain flag.ab.length == 16
    }
    constrain {
        other.eye.rim.radius == 3
        flags.right_of(other, at_least: 20)
    }
}
