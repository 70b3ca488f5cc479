# A comment of the other kind.
/* And one
   over lines. */
/// Documents the part; unicode names are names.
solid größe { // note
    π_hälfte = circle(center: (0, 0), radius: 3); breite = 4
    名前 = rectangle(width: breite, height: 2)
    constrain { 名前.center == π_hälfte.center; }
    ; ;
}
