/// Several roots and geometry beside them make an implicit assembly.
param size = 20
let half = size / 2
construction base = line(fixed((-50, 0)), fixed((50, 0)))
solid left { block = square(size: size) }
solid right { block = square(size: half) }
constrain {
    left.bottom == base
    right.bottom == base
    left.left_of(right, gap: half)
    left.left == -30
}
