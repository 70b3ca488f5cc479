/// A claw hammer standing on its handle.
assembly claw_hammer {
    param length = 280 in 240..330

    solid handle { grip = rounded_rectangle(center: (0, -0.5 * length), width: 26, height: length, radius: 8) }
    assembly head {
        solid cheek { block = rectangle(center: (0, 8), width: 34, height: 36) }
        solid face { bell = rounded_rectangle(center: (36, 8), width: 40, height: 30, radius: 3) }
        solid claw {
            prong = polygon([(-16, 24), (-16, -2), (-50, -4), (-86, -32), (-60, 14)])
        }
    }
}
