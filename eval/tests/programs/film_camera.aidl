/// A film camera from the front.
assembly film_camera {
    param width = 130 in 100..160

    solid shutter_button { cap = rounded_rectangle(center: (-40, 44), width: 14, height: 8, radius: 2) }
    solid dial { knob = rounded_rectangle(center: (42, 45), width: 20, height: 10, radius: 2) }
    solid prism { housing = trapezoid(center: (0, 48), bottom_width: 50, top_width: 30, height: 16) }
    solid body { box = rounded_rectangle(center: origin, width: width, height: 80, radius: 8) }
    solid viewfinder { window = rounded_rectangle(center: (0, 48), width: 18, height: 8, radius: 1) }
    solid lens {
        barrel = circle(center: (0, -6), radius: 28)
        hole glass { rim = circle(center: (0, -6), radius: 18) }
    }
}
