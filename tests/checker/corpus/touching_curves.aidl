/// Tangency of several things at once, of ellipses, of arcs without a shared end, from inside and outside.
drawing touching_curves {
    ground = line(fixed((0, 0)), fixed((200, 0)))
    wheel  = circle(center: (20, 18), radius: 15)
    ball   = circle(center: (55, 12), radius: 8)
    egg    = ellipse(center: (90, 14), rx: 12, ry: 8, angle: fixed(30deg))
    bow    = arc(center: (130, 12), radius: 10, start_angle: 180deg, end_angle: 330deg)
    hoop   = circle(center: (160, 40), radius: guess(30))
    drop   = circle(center: (150, 40), radius: 8)
    stone  = circle(center: (215, 40), radius: 9)
    wave   = bezier((0, 60), (10, 80), (20, 70), (30, 60))
    shore  = line(wave.p3, (60, 45))
    constrain {
        tangent(wheel, ball, egg, bow, ground)
        tangent(ball, wheel)
        tangent(drop, hoop, inside: true)
        tangent(stone, hoop, inside: false)
        hoop.radius == 31
        tangent(shore, wave)
    }
}
