/// Placement: on circles, at corners, spread through a box; points between things and lines through them.
assembly places {
    solid flange {
        rim = circle(center: fixed((3, 4)), radius: 40)
        for i in 0..5 { hole bolt[i] { bore = circle(center: polar(30, 60deg * i + 10deg), radius: 3) } }
        for i in 0..2 { hole pin[i] { bore = circle(center: polar(15, -100deg * i), radius: 2) } }
        for i in 0..2 { hole dot[i] { bore = circle(center: polar(6, 90deg * i), radius: 1) } }
        constrain {
            on_circle(bolt, center: rim.center, diameter: 60, start: 30deg)
            on_circle(pin, center: rim.center, radius: 17)
            on_circle(dot, center: rim.center, radius: 7, evenly: false)
        }
    }
    drawing ring_ {
        track = circle(center: (120, 0), radius: 22)
        for i in 0..4 { mark[i] = circle(center: (120, 0) + polar(25, 80deg * i), radius: 2) }
        constrain on_circle(mark, around: track, start: 90deg)
    }
    solid plate {
        body = rectangle(center: (0, 100), width: 80, height: 50)
        for i in 0..3 {
            hole screw[i] { bore = circle(center: (0, 100) + polar(20, 90deg * i + 225deg), radius: 3) }
            hole stud[i] { bore = circle(center: (0, 100) + polar(9, 90deg * i + 45deg), radius: 1) }
        }
        constrain {
            at_corners(screw, body, inset: 8)
            at_corners(stud, body, inset: (20, 12))
        }
    }
    solid panel {
        body = rectangle(center: (200, 100), width: 120, height: 40)
        for i in 0..4 { hole slit[i] { cut = slot(start: (180 + 9 * i, 92), end: (180 + 9 * i, 108), width: 6) } }
        for i in 0..2 { hole eye[i] { cut = circle(center: (150, 95 + 6 * i), radius: 2) } }
        constrain {
            spread(slit, inside: body, margin: 10)
            align_center_y(slit, body)
            spread(eye, inside: body, axis: y)
        }
    }
    drawing points {
        a = circle(center: fixed((300, 0)), radius: 5)
        b = circle(center: fixed((360, 20)), radius: 5)
        lamp = circle(center: between(a, b), radius: 3)
        nail = circle(center: between(a, b, 0.25), radius: 1)
        card = rectangle(center: (330, 60), width: 60, height: 40)
        tack = circle(center: (320, 80), radius: 2)
        left_ear  = circle(center: (318, 50), radius: guess(3))
        right_ear = circle(center: (350, 51), radius: 6)
        chin = circle(center: (333, 30), radius: 2)
        brow = circle(center: (333, 99), radius: 2)
        ray  = circle(center: (380, 40), radius: 2)
        stamp = circle(center: (340, 70), radius: 2)
        sign = polygon(spots(card, [(0.1, 0.1), (0.3, 0.1), (0.2, 0.3)]))
        constrain {
            coincident(tack.center, anchor(card, "top_left") + (5, -5))
            symmetric(left_ear, right_ear, about: vertical_through(card.center))
            symmetric(chin, brow, about: horizontal_through(card.center))
            coincident(stamp.center, card.spot(0.8, 0.75))
            coincident(ray.center, line_through(b.center, 45deg))
        }
    }
}
