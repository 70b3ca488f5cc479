/// Lists, comprehensions, `min` and `max` over unknowns.
// changes: roof
drawing towers {
    let heights = [12, 20, 8, 15]
    for i in 0..<len(heights) {
        tower[i] = rectangle(center: (15 * i, heights[i] / 2), width: 10, height: heights[i])
    }
    roof = line((0, 30), (60, 31))
    constrain {
        for t in tower { t.bottom == 0 }
        roof.start.y == max([t.top.midpoint.y for t in tower]) + 3
        horizontal(roof)
        roof.start.x == min([t.bb.left for t in tower])
        roof.end.x == max([tower[i].bb.right for i in 0..3 if heights[i] > 10])
    }
    assert sum([t.height for t in tower]) == sum(heights)
    assert min(heights) == 8 and max(heights) == 20
}
