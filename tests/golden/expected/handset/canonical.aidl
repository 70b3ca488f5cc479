/// The handset of a telephone, with the flaw that constraints mend: as written, `right_round` floats beside
/// the base. References share points (`base.top_left`); constraints say what must agree.
solid handset {
    base = rectangle(center: (0, 0), width: 100, height: 20)

    // The left ear hangs on points of the base, so it cannot come off.
    left_round = arc(center: (-50, -4), start: base.top_left, end: (-64, -4))
    left_line = line(left_round.end, (-64, -20))
    left_fillet = arc(center: (-57, -20), start: left_line.end, end: (-50, -20))
    left_inner = line(left_fillet.end, base.bottom_left)

    // The right ear was written by eye: `guess` says that not even the shape of an arc is meant as written.
    right_round = arc(center: (54, -5), start: guess((68, -6)), end: guess((54, 9)))
    right_line = line(right_round.start, (67, -18))
    right_fillet = arc(center: (58, -19), start: guess((51, -20)), end: right_line.end)
    right_inner = line(right_fillet.start, base.bottom_right)

    constrain {
        coincident(right_round.end, base.top_right)
        vertical(left_line)
        vertical(right_line)
        vertical(left_inner)
        vertical(right_inner)
        right_line.length == left_line.length
        right_fillet.diameter == left_fillet.diameter
        tangent(left_line, left_fillet)
        tangent(right_line, right_fillet)
        tangent(right_round, right_line)
        right_fillet.start.y == left_fillet.end.y
    }
}
