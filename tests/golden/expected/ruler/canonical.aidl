/// A ruler with a tick every millimetre, longer ones at 5 and 10 mm with their numbers, and a hole to hang it by.
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
        for i in 0..length step 10 {
            number[i] = text(str(i), center: fixed((i, -12)), height: 3)
        }
        unit = text("mm", start: fixed((2.5, -18)), height: 2)
    }

    constrain {
        scale.top == blade.top
        scale.tick[0].start.x == blade.left + margin
    }

    assert scale.right <= blade.eye.left - 2mm, "the scale runs into the hole"
    assert scale.bottom >= blade.bottom + 1mm, "the blade is too narrow for the numbers"
    assert scale.number[50].center.x - scale.number[0].center.x == 50mm,
        "a number is not at its tick"
}
