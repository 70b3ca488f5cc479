/// Blocks among arguments: steps of a path, corners of a polygon, things of a relation.
assembly stage {
    param teeth = 6 in 3..9

    @detached solid curtain {
        hem = path(
            from: (0, 0),
            for i in 0..<teeth {
                let x = 10 * i
                line_to((x + 5, -4))
                line_to((x + 10, 0))
            }
            if teeth > 4 { line_to((10 * teeth, 40)) } else { line_to((10 * teeth, 30)) }
            line_to((0, 40)),
            close()
        )
    }

    @detached solid crown {
        edge = polygon((0, 60), for i in 0..3 { (10 * i + 5, 80), (10 * i + 10, 66) }, (45, 60))
    }

    @detached solid base {
        for i in 0..2 { foot[i] = rectangle(center: (30 * i, -30), width: 8, height: 10) }
    }

    constrain {
        crown.above(curtain, gap: 5)
        base.below(curtain, gap: 2)
        align_bottom(for f in base.foot { f })
    }
}
