/// A robot's face: a head with two eyes, a mouth with teeth, two ears and an antenna.
assembly robot_face {
    @color("silver")
    solid head {
        plate = rounded_rectangle(center: origin, width: 100, height: 90, radius: 12)
        for side in 0..1 {
            hole eye[side] {
                socket = circle(center: (50 * side - 25, 18), radius: 13)
                solid pupil { ball = circle(center: (50 * side - 25, 18), radius: guess(5)) }
                constrain {
                    pupil.ball.center == socket.center
                    pupil.ball.radius == 0.4 * socket.radius
                }
            }
        }
        hole mouth {
            opening = slot(center: (0, -22), length: 56, width: 14)
        }
        constrain {
            symmetric(eye[0].socket, eye[1].socket, about: y_axis)
            mouth.center_x == plate.center.x
            mouth.below(eye[0], at_least: 10)
        }
    }
    @color("gray")
    solid ears {
        left = rectangle(center: (-56, 0), width: 12, height: 30)
        right = rectangle(center: (56, 0), width: 12, height: 30)
    }
    @color("crimson")
    solid antenna {
        rod = rectangle(center: (0, 55), width: 3, height: 20)
        ball = circle(center: (0, 68), radius: 5)
        constrain ball.center == rod.top.midpoint
    }
    constrain {
        antenna.stacked_on(head)
        ears.centered_in(head)
    }
}
