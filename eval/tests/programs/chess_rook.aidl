/// A chess rook from the side.
assembly rook {
    @color("black")
    solid base {
        foot = rectangle(width: 60, height: 10)
        tread = rectangle(width: 50, height: 6)
        constrain tread.stacked_on(foot)
    }
    @color("black")
    solid shaft { walls = trapezoid(bottom_width: 40, top_width: 30, height: 50) }
    @color("black")
    solid crown {
        block = rectangle(width: 48, height: 22)
        for i in 0..1 {
            hole notch[i] { gap = rectangle(center: (16 * i - 8, 8), width: 8, height: 8) }
        }
        constrain {
            notch[0].top == block.top
            notch[1].top == block.top
            evenly_spaced(notch, axis: x)
            centered_horizontally(notch, block)
        }
    }
    constrain {
        shaft.stacked_on(base)
        crown.stacked_on(shaft)
    }
}
