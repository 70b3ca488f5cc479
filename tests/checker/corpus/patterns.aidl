/// Rows, grids and circles of geometry and of templates; their centre, pitch and radius can be constrained.
// changes: strip.bores
assembly patterns {
    hole bore(r = 3) { rim = circle(center: origin, radius: r) }
    solid strip {
        plate = rectangle(center: origin, width: 100, height: 16)
        bores = linear_array(bore(r: 2), n: 5, pitch: 15, center: (1, 2))
        constrain {
            bores.center == plate.center
            bores.pitch == 18
        }
    }
    solid board {
        plate = rectangle(center: (0, 50), width: 60, height: 40)
        holes = grid(bore(r: 2), columns: 4, rows: 3, pitch_x: 11, pitch_y: guess(10), center: (0, 50))
        constrain {
            holes.center == plate.center
            holes.pitch_y == 12
            holes[3][2].right <= plate.bb.right - 5
        }
    }
    solid dial {
        plate = circle(center: (0, 120), radius: 30)
        hole slit(length = 6) { edge = slot(center: origin, length: length, width: 3) }
        slits = polar_array(slit(length: 10), n: 9, radius: guess(20), center: (0, 120))
        constrain {
            slits.center == plate.center
            slits.radius == 22
        }
    }
    drawing fan {
        blade = rectangle(center: (130, 0), width: 20, height: 4)
        blades = polar_array(blade, n: 5, center: (100, 0), sweep: 120deg)
        dots = polar_array(circle(radius: 2), n: 6, radius: 40, center: (100, 0), turn: false)
        steps = linear_array(square(size: 4), n: 4, by: (6, 3), start: (150, 50))
        constrain steps.start == (151, 51)
    }
    constrain {
        board.above(strip, gap: 5)
        dial.above(board, gap: 5)
    }
}
