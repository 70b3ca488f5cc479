/// A flat bottle opener: a handle with a hole for a hook, a round head, and a mouth with a tooth that lifts the cap.
@thickness(4mm)
@material("stainless steel")
solid bottle_opener {
    param length = 130mm in 90..180
    param mouth = 28mm in 26..32  // a crown cap is 26 mm wide below its teeth

    handle = rounded_rectangle(width: length, height: 28, radius: 14)
    head = circle(radius: 26)

    hole hook {
        rim = circle(diameter: 10)
    }

    hole opening {
        cap = circle(diameter: mouth)
        solid tooth rotated -90deg {
            lip = trapezoid(bottom_width: 16, top_width: 10, height: 8)
        }
        constrain {
            tooth.center_x == cap.center.x - 0.5 * mouth + 4
            tooth.center_y == cap.center.y
        }
    }

    constrain {
        head.center == handle.center + (0.5 * length - 22, 0)
        hook.center == handle.center - (0.5 * length - 14, 0)
        opening.cap.center == head.center
    }

    assert 26 - mouth / 2 >= 8, "the head is too weak around its mouth"
}
