/// A table lamp: a foot, a turned stem and a shade.
assembly table_lamp {
    @color("sienna")
    solid base { foot = trapezoid(bottom_width: 80, top_width: 50, height: 14) }
    @color("sienna")
    solid stem {
        rod = rectangle(width: 8, height: 110)
        bead = circle(radius: 12)
        constrain bead.center == rod.center
    }
    @color("lemonchiffon")
    solid shade { screen = trapezoid(bottom_width: 120, top_width: 70, height: 80) }
    constrain {
        stem.stacked_on(base)
        shade.centered_horizontally(stem)
        shade.bottom == stem.top - 15
    }
}
