/// A round teapot with a lid, a spout on the right and a handle on the left.
assembly teapot {
    @color("steelblue")
    solid pot {
        belly = ellipse(center: origin, rx: 60, ry: 45)
        foot = rectangle(center: (0, -45), width: 60, height: 10)
    }

    @color("midnightblue")
    solid lid {
        plate = segment(middle: (0, 45), width: 50, height: 12)
        knob = circle(center: (0, 60), radius: 6)
        constrain knob.center == plate.chord.midpoint + (0, 14)
    }

    @color("steelblue")
    solid spout {
        tube = polygon([(40, -15), (100, 35), (90, 42), (40, 15)])
    }

    @color("midnightblue")
    solid grip {
        loop = ring(center: (-65, 0), outer_radius: 28, inner_radius: 20)
    }

    constrain {
        lid.centered_horizontally(pot)
        lid.bottom == pot.top - 4
        grip.center_x == pot.left - 8
        grip.center_y == pot.belly.center.y
    }
}
