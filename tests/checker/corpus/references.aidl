/// Shared and derived references: no unknowns of their own.
// changes: foot
solid bracket {
    var reach = 30
    foot  = line((0, 0), (40, 1))
    riser = line(foot.end, (41, 30))
    back  = line(riser.end, foot.start + (0, 30))
    side  = line(back.end, foot.start)
    pivot = circle(center: foot.midpoint + (0, 12), radius: foot.length / 8)
    twin  = circle(center: (pivot.center.x, 22), radius: pivot.radius)
    stop  = point(reach, 5)
    cap   = arc(center: pivot.center, start: (26, 12), end: (20, 18))
    constrain {
        horizontal(foot)
        vertical(riser)
        foot.length == 44
        reach == 33
        twin.center.y - pivot.center.y == 9
    }
}
