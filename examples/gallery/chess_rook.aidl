/// A turned wooden chess rook on its board: rings, a hollow shaft and battlements, each on the one below.
assembly chess_rook {
    /// Height of the piece, from its felt to the battlements.
    param height = 100mm in 86..130
    /// Diameter of the foot.
    param base = 56mm in 46..64
    /// How slender the shaft is at its narrowest, as a share of the foot.
    param waist = 0.46 in 0.38..0.56
    /// Battlements that are seen from the front.
    param merlons = 3 in 3..5 step 1

    let u = base / 100
    let tall = height - 83 * u - 2
    let wood = "#b9773c"

    @color("#8a5a33")
    solid border { bar = rectangle(center: (0, -18), width: 210 * u + 8, height: 6) }
    @color("#e9dcc0")
    solid board { plank = rectangle(center: (0, -6), width: 210 * u, height: 12) }
    @color("#4a3426")
    solid fields { squares = ribs(board.plank, pitch: 42 * u) }
    @color("#2f5d3a")
    solid felt { pad = rectangle(center: (0, 1), width: 95 * u, height: 2) }
    @color(darker(wood, 0.45))
    solid inside { far_side = rectangle(center: (0, height), width: 68 * u, height: 8 * u) }

    @color(wood)
    solid piece {
        foot = rounded_rectangle(center: (0, 6), width: base, height: 16 * u, radius: 5 * u)
        cushion = path(
            from: (0, 16),
            right(40 * u),
            bezier_to((40 * u, 16 + 7 * u), (33 * u, 16 + 10 * u), (32 * u, 16 + 13 * u)),
            left(32 * u),
            mirrored(about: y_axis)
        )
        shaft = path(
            from: (0, 30),
            right(31 * u),
            bezier_to(
                (waist * 50 * u, 30 + tall / 4),
                (waist * 48 * u, 30 + 0.6 * tall),
                (29 * u, 30 + tall)
            ),
            left(29 * u),
            mirrored(about: y_axis)
        )
        bell = trapezoid(center: (0, 80), bottom_width: 56 * u, top_width: 68 * u, height: 10 * u)
        drum = rounded_rectangle(center: (0, 85), width: 74 * u, height: 10 * u, radius: 2 * u)
        for i in 0..<merlons {
            merlon[i] = rectangle(
                center: (20 * i - 20, 90), width: 44 * u / merlons, height: 14 * u
            )
        }
        constrain {
            evenly_spaced(merlon, axis: x)
            for m in merlon { m.bottom == drum.top }
            merlon[0].left == drum.left
            merlon[-1].right == drum.right
        }
    }

    /// What the lathe has cut a groove around is a little darker.
    @color(darker(wood, 0.12))
    solid rings {
        plinth = rounded_rectangle(center: (0, 14), width: 90 * u, height: 6 * u, radius: 2 * u)
        bead = slot(center: (0, 27), length: 68 * u, width: 7 * u)
        collar = slot(center: (0, 75), length: 66 * u, width: 7 * u)
    }

    @color(darker(wood, 0.2))
    drawing grain { lines = wood_grain(piece.shaft, pitch: 9 * u, angle: 90deg, margin: 1) }
    let turned = [piece.foot, piece.cushion, piece.shaft, piece.bell, piece.drum]
    let parts = turned + [piece.merlon[-1], rings.plinth, rings.bead, rings.collar]

    /// The light falls from the left.
    @color(darker(wood, 0.35))
    solid shade {
        for i, p in enumerate(parts) {
            side[i] = difference(p, copy(p, by: (-10 * u, 0)))
        }
    }
    @color(lighter(wood, 0.45))
    solid shine {
        drum = slot(center: (-18 * u, 86), length: 18 * u, width: 2.5 * u)
        streak = clip(thick(copy(piece.shaft.segment[4], by: (10 * u, 0)), 4 * u), by: piece.shaft)
    }

    constrain {
        column(piece.drum, piece.bell, rings.collar, piece.shaft, gap: 0, align: center)
        column(
            piece.shaft, rings.bead, piece.cushion, rings.plinth, piece.foot, gap: 0, align: center
        )
        column(piece.foot, felt, board, border, gap: 0, align: center)
        inside.on_top_of(piece.drum, align: center)
        shine.drum.center == piece.drum.center + (-18 * u, 1.5 * u)
    }
    assert piece.top - felt.bottom == height, "the piece is as tall as asked for"
}
