/// A house: walls with a door and two windows, a roof, and a chimney that comes out of the roof.
assembly house {
    param width = 120 in 80..200

    @color("wheat")
    solid walls {
        wall = rectangle(center: (0, 40), width: width, height: 80)
        hole door {
            leaf = rectangle(center: (0, 20), width: 22, height: 44)
            solid knob { ball = circle(center: (8, 20), radius: 2) }
        }
        for i in 0..1 {
            hole window[i] {
                pane = rectangle(center: (80 * i - 40, 45), width: 20, height: 20)
            }
        }
        constrain {
            door.bottom == wall.bottom
            door.center_x == wall.center.x
            align_center_y(window[0], window[1])
            window[0].center_x == wall.left + 25
            window[1].center_x == wall.right - 25
        }
    }

    @color("firebrick")
    solid roof {
        gable = triangle(base: width + 20, height: 50)
    }

    @color("sienna")
    solid chimney {
        stack = rectangle(center: (30, 120), width: 14, height: 45)
        cap = rectangle(center: (30, 145), width: 18, height: 5)
        constrain stacked_on(cap, stack)
    }

    constrain {
        roof.stacked_on(walls)
        chimney.center_x == roof.center_x + 30
        chimney.bottom == roof.bottom + 15
    }
}
