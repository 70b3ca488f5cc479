/// A coat hanger: two sloping shoulders and a bar from one outline, and a hook that meets it at the top.
solid hanger {
    param span = 400mm in 300..450  // from shoulder to shoulder
    param drop = 90mm in 60..140    // how far the shoulders fall
    param stock = 16mm in 10..25    // how thick it is

    // Outside: two slopes that meet under the hook, and the bar.
    left_tip = (-200, 0)
    right_tip = (200, 0)
    peak = (0, 90)
    left_slope = line(left_tip, peak)
    right_slope = line(peak, right_tip)
    bar = line(right_tip, left_tip)

    // Inside: the same outline, smaller.
    hole window {
        left = (-150, 16)
        right = (150, 16)
        top = (0, 70)
        left_side = line(left, top)
        right_side = line(top, right)
        sill = line(right, left)
    }

    solid hook {
        stem = rectangle(width: stock, height: 40)
        bend = arc(
            center: (30, 60), radius: 30, start_angle: fixed(-30deg), end_angle: fixed(180deg)
        )
        inner = arc(
            center: bend.center,
            radius: 30 - stock,
            start_angle: fixed(-30deg),
            end_angle: fixed(180deg)
        )
        tip = line(bend.start, inner.start)
        root = line(bend.end, inner.end)
        constrain bend.end == stem.top_left
    }

    constrain {
        horizontal(bar)
        bar.length == span
        equal(left_slope, right_slope)
        peak.y - left_tip.y == drop

        parallel(window.left_side, left_slope)
        parallel(window.right_side, right_slope)
        horizontal(window.sill)
        distance(window.sill, bar) == stock
        distance(window.left_side, left_slope) == stock
        distance(window.right_side, right_slope) == stock

        hook.stem.center.x == peak.x
        hook.stem.bottom == peak.y - stock / 2
    }
}
