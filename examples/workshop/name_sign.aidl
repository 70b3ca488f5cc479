/// A sign for a door, cut from plywood: the name is cut through, bridged so that no piece falls out, and the line under it is
/// engraved in one pass. Two holes for screws, and a rim engraved around it all.
@thickness(4mm)
@material("birch plywood")
@title("Name sign")
@color("burlywood")
solid name_sign {
    param name = "HARBOUR"
    param under = "Bakery & Café, since 1931"
    param height = 80mm in 60..120
    param bridge = 1.6mm in 1..4  // no bridge may be thinner than the cutter is true
    let letter = 0.34 * height
    let away = 0.11 * height  // of the screws from the ends

    hole lettering { line = text(name, height: letter, bold: true, stencil: bridge) }
    drawing engraving { line = text(under, height: 0.1 * height, font: "single line") }

    plate = rounded_rectangle(width: guess(200), height: height, radius: 0.1 * height)
    drawing rim {
        edge = rounded_rectangle(width: guess(190), height: height - 8, radius: 0.1 * height - 4)
    }
    hole left_screw { rim = circle(diameter: 4.5mm) }
    hole right_screw { rim = circle(diameter: 4.5mm) }

    constrain {
        plate.center == (0, 0)
        plate.width == lettering.width + 5 * away
        rim.edge.center == plate.center
        rim.edge.width == plate.width - 8
        lettering.line.center == plate.center + (0, 0.1 * height)
        engraving.line.center == plate.center - (0, 0.28 * height)
        left_screw.rim.center == plate.left.midpoint + (away, 0)
        right_screw.rim.center == plate.right.midpoint - (away, 0)
    }

    assert engraving.width <= rim.edge.width - 10, "the line under the name is too long: shorten it"
}
