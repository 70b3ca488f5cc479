/// Unknowns shared by many, inequalities, chains, membership, `and`.
assembly fence {
    var gap = 5
    var tall = 20
    for i in 0..2 {
        solid post[i] { board = rectangle(center: (10 * i, 0), width: 4, height: guess(20)) }
    }
    constrain {
        for i in 0..1 { post[i + 1].left == post[i].right + gap }
        for p in post { p.height == tall }
        3 <= gap <= 4
        tall in 25..40
        post[0].left == 0 and post[0].bottom == 0
        align_bottom(post)
    }
}
