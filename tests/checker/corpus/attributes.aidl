/// Attributes take any build-time value; orientation, colour, layer, thickness, material, notes.
@orientation(front) @note("a box")
assembly crate {
    let shade = "tan"
    @color(shade) @thickness(2 * 1.5mm) @material("pine")
    solid wall { board = rectangle(width: 60, height: 40) }
    @layer("cut") @detached
    solid label { tag = rectangle(width: 12, height: 6) }
    @color("#ff8800")
    drawing stripe { s = line((0, 0), (40, 0)) }
    constrain {
        label.above(wall, gap: 12)
        stripe.centered_in(wall)
        label.centered_horizontally(stripe)
    }
}
