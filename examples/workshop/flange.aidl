/// A flange that closes a pipe: a bore for its end and holes for the bolts on a pitch circle.
@thickness(12mm)
@material("steel S235")
@title("Blind flange DN 40")
@author("A. Maker")
@number("FL-040")
@revision("A")
solid flange {
    param bore = 44mm in 20..60
    param pitch = 100mm in 90..110
    param bolt = 14mm in 9..18
    param bolts = 6 in 4..8

    disc = circle(center: origin, diameter: pitch + 40)
    hole pipe { rim = circle(center: origin, diameter: bore) }
    for i in 0..<bolts {
        hole bolt_hole[i] { rim = circle(center: fixed(polar(pitch / 2, 360deg * i / bolts)), diameter: bolt) }
    }

    assert pitch / 2 - bore / 2 - bolt / 2 >= 10, "the wall between bore and bolts is thin"
}
