/// Gears that run together: two, shifted ones, one in a ring, one on a bar.
assembly meshing {
    drawing pinion { body = gear(teeth: 12, module: 2, center: (0, 0)) }
    drawing wheel  { body = gear(teeth: 25, module: 2, center: (30, 20), angle: guess(3deg)) }
    drawing third  { body = gear(teeth: 17, module: 2, center: (90, 10), angle: guess(0deg)) }
    drawing small  { body = gear(teeth: 9, module: 2, center: (200, 0), profile_shift: 0.4) }
    drawing large  { body = gear(teeth: 21, module: 2, center: (230, 8), profile_shift: 0.1, angle: guess(1deg)) }
    drawing ring_  { body = internal_gear(teeth: 36, module: 2, outer_radius: 44, center: (0, 200)) }
    drawing planet { body = gear(teeth: 13, module: 2, center: (20, 210), angle: guess(1deg)) }
    drawing bar    { body = rack(teeth: 8, module: 2, height: 5, center: (200, 200)) }
    drawing roller { body = gear(teeth: 14, module: 2, center: (203, 220), angle: guess(2deg)) }
    constrain {
        meshes(wheel.body, pinion.body)
        meshes(third.body, wheel.body, backlash: 0.1)
        meshes(large.body, small.body)
        meshes(planet.body, ring_.body)
        meshes(bar.body, roller.body)
    }
}
