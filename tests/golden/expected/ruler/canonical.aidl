/// A ruler with a tick every millimetre, longer ones at 5 and 10 mm, and a hole to hang it by.
assembly ruler {
    param length = 100mm in 50..300
    param width = 30mm in 20..40
    let margin = 5mm

    solid blade {
        edge = rounded_rectangle(width: length + 2 * margin + 15, height: width, radius: 3)
        hole eye {
            rim = circle(diameter: 6)
        }
        constrain {
            eye.rim.center.y == edge.center.y
            eye.right == edge.bb.right - 5
        }
    }

    /// Engraved: strokes on top of the blade, their feet on its upper edge.
    @layer("engrave")
    drawing scale {
        for i in 0..length {
            tick[i] = line(
                fixed((i, 0)),
                fixed((i, if i % 10 == 0 then -9 else if i % 5 == 0 then -6.5 else -4))
            )
        }
    }

    constrain {
        scale.top == blade.top
        scale.left == blade.left + margin
    }

    assert scale.right <= blade.eye.left - margin, "the ticks run into the hole"
}
