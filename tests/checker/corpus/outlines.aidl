/// Paths with arcs, smooth joints and Béziers, and splines: their joints are asked for by what each step says.
// changes: flow.edge.steps[0], flow.edge.steps[3].to, flow.edge.steps[6].through
assembly outlines {
    solid tag {
        edge = path(
            from: (0, 0),
            line_to((40, 0)),
            arc_to((40, 20), radius: 10),
            line_to((0, 20)),
            close()
        )
        constrain edge.segment[0].length == 40
    }
    solid hook {
        edge = path(from: (100, 0), right(40), arc_by(180deg, radius: 15), forward(20), up(4), close())
    }
    drawing flow {
        edge = path(
            from: (200, 0),
            heading: 10deg,
            line_by(length: 30, angle: 10deg),
            tangent_arc_to((240, 20)),
            bezier_to((230, 40), (220, 45), (200, 40), smooth: true),
            quadratic_to((190, 30), (180, 44)),
            line_to((170, 66), smooth: true),
            arc_to((150, 66), center: (160, 66)),
            arc_to((120, 60), through: (135, 50)),
            horizontal_to(100),
            vertical_to(70)
        )
        constrain {
            edge.corner[1].x == 231
            edge.segment[6].radius == 16
        }
    }
    solid pebble {
        edge = spline((0, 100), (30, 95), (45, 115), (20, 130), (-5, 120), closed: true)
    }
    drawing trail {
        way = spline([(100, 100), (130, 110), (150, 95), (180, 100)])
        constrain way.knot[2] == (151, 96)
    }
    solid steel { profile = rectilinear_polygon((0, 200), (40, 200), (40, 205), (5, 205), (5, 230), (0, 230)) }
    constrain hook.above(tag, gap: 10)
}
