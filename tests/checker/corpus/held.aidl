/// What is held where it was written; structures that mirror each other.
// changes: needle
assembly scale {
    solid post at (0, 5) { board = rectangle(center: (0, 20), width: 4, height: 40) }
    solid left_pan { dish = trapezoid(center: (-30, 12), bottom_width: 10, top_width: 20, height: 5) }
    solid right_pan { dish = trapezoid(center: (25, 9), bottom_width: 10, top_width: 20, height: 5) }
    needle = line((0, 30), (3, 44))
    tick   = circle(center: (9, 50), radius: 1)
    constrain {
        fixed(post)
        fixed(tick)
        symmetric(right_pan, left_pan, about: y_axis)
        left_pan.left_of(post, gap: 20)
        needle.end == tick.center
        symmetric(needle.start, post.board.bottom_left, axis: y)
    }
}
