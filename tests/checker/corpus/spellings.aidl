// Generous spellings: other words for the same things.
part holder {
    component Body { Plate = rect(center = [0, 0], width = 40, height = 20) }
    cut window { pane = Rectangle(center: (2, 2), width: 10, height: 5) }
    sketch label { text_line = line((0, 0), (10, 0)) }
    constrain {
        centerInside(window, Body)
        label.underneath(body, gap: 2),
        label.to_the_left_of(window, gap: 1);
        Body.plate.Width = 40
        window.pane.width**2 == 100 && true
    }
}
