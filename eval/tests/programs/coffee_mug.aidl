/// A coffee mug from the side, with a handle on the right.
solid mug {
    body = rounded_rectangle(center: origin, width: 80, height: 95, radius: 8)
    solid handle {
        loop = ring(center: (45, 0), outer_radius: 30, inner_radius: 20)
    }
    constrain handle.loop.outer.center == body.right.midpoint + (5, 0)
}
