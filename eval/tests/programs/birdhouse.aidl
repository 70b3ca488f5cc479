/// A birdhouse with a round entrance.
assembly birdhouse {
    param width = 120 in 90..160

    solid box {
        front = rectangle(center: origin, width: width, height: 140)
        hole entrance { rim = circle(center: (0, 20), diameter: 34) }
    }
    solid roof { gable = triangle(bottom_center: (0, 70), base: width + 40, height: 60) }
    solid perch { peg = circle(center: (0, -20), radius: 5) }
}
