/// A toy sword in four parts that fit on each other: pommel, grip, guard and blade.
assembly toy_sword {
    param blade_length = 260mm in 150..400
    param blade_width = 36mm in 20..60

    @color("silver")
    solid blade {
        body = rectangle(width: blade_width, height: blade_length - blade_width)
        tip = triangle(base: blade_width, height: blade_width)
        constrain {
            tip.bottom_left == body.top_left
        }
    }

    @color("goldenrod")
    solid guard {
        bar = rounded_rectangle(width: 110, height: 18, radius: 9)
    }

    @color("sienna")
    solid grip {
        handle = trapezoid(bottom_width: 24, top_width: 20, height: 90)
    }

    @color("goldenrod")
    solid pommel {
        ball = circle(radius: 16)
        hole cord {
            rim = circle(diameter: 6)
        }
        constrain cord.rim.center == ball.center
    }

    constrain {
        guard.stacked_on(grip)
        blade.stacked_on(guard)
        grip.centered_horizontally(pommel)
        grip.bottom == pommel.top - 3
        guard.width >= 2 * blade.width
    }

    assert blade.height == blade_length, "the blade has the length that was asked for"
}
