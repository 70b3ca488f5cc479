/// A lighthouse on a rock: stacked parts, each only as tall or wide as it says, placed by how they stand on each other.
assembly lighthouse {
    param tower_height = 120mm in 60..200
    param stripes = 3 in 1..5
    let foot = 56mm
    let head = 36mm

    @color("slategray")
    solid rock {
        hill = segment(radius: 70, start_angle: fixed(30deg), end_angle: fixed(150deg))
    }

    @color("whitesmoke")
    solid tower {
        walls = trapezoid(bottom_width: foot, top_width: head, height: tower_height)
        hole door {
            arch = arc(
                center: (0, 10), radius: 6, start_angle: fixed(0deg), end_angle: fixed(180deg)
            )
            left = line(arch.end, (-6, 0))
            sill = line(left.end, (6, 0))
            right = line(sill.end, arch.start)
            constrain {
                vertical(left)
                horizontal(sill)
                vertical(right)
                left.length == 12
            }
        }
        for i in 0..1 {
            hole window[i] {
                pane = rectangle(width: 7, height: 10)
            }
            constrain {
                window[i].center_x == walls.center.x
                window[i].center_y == walls.bottom.midpoint.y + (0.45 + 0.3 * i) * tower_height
            }
        }
        constrain {
            door.bottom == walls.bottom
            door.center_x == walls.center.x
        }
    }

    /// Bands around the tower, each reaching to its slanted sides.
    @color("firebrick")
    drawing bands {
        for i in 0..<stripes {
            let low = (i + 0.55) / (stripes + 0.4) * tower_height
            let half = foot / 2 - (foot - head) / 2 * low / tower_height
            edge[i] = line(fixed((-half, low)), fixed((half, low)))
        }
    }

    @color("dimgray")
    solid gallery {
        deck = rectangle(width: head + 16, height: 5)
    }

    @color("gold")
    solid lantern {
        glass = rectangle(width: head - 10, height: 20)
    }

    @color("firebrick")
    solid roof {
        cone = triangle(base: head, height: 18)
        ball = circle(radius: 3)
        constrain ball.center == cone.apex
    }

    constrain {
        tower.bottom == rock.top - 6
        tower.centered_horizontally(rock)
        bands.center_x == tower.center_x
        gallery.stacked_on(tower)
        lantern.stacked_on(gallery)
        roof.stacked_on(lantern)
        bands.bottom == tower.bottom + 0.55 / (stripes + 0.4) * tower_height
    }
}
