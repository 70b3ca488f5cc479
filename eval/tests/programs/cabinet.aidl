/// A cabinet with three drawers, each with a knob, on two legs.
assembly cabinet {
    param width = 300 in 200..500

    @color("tan")
    solid case {
        box = rectangle(width: width, height: 360)
        for i in 0..1 { leg[i] = rectangle(center: (200 * i - 100, -190), width: 20, height: 30) }
        constrain {
            leg[0].top == box.bottom
            leg[1].top == box.bottom
            leg[0].left == box.left + 10
            leg[1].right == box.right - 10
        }
    }

    @color("burlywood")
    solid drawer(height = 100, width = 280) {
        front = rectangle(width: width, height: height)
        hole knob { rim = circle(radius: 8) }
        constrain knob.rim.center == front.center
    }

    for i in 0..2 { drawers[i] = drawer(width: width - 30) at (0, 110 * i - 110) }

    constrain {
        evenly_spaced(drawers, axis: y, gap: 12)
        centered_in(drawers, case.box)
    }
}
