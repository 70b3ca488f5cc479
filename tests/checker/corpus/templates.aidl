/// Templates with arguments, placed, turned, in arrays, inside each other.
assembly cabinet {
    solid bolt(size = 6, head = 10) {
        shank = rectangle(width: size, height: 30)
        top   = circle(radius: head / 2)
        constrain {
            top.center == shank.top.midpoint
        }
    }
    solid plate(w = 60, h = 20) {
        sheet = rectangle(width: w, height: h)
        for i in 0..1 {
            hole bore[i] { rim = circle(radius: 2 + i) }
            constrain bore[i].center == sheet.center + (w / 4 * (2 * i - 1), 0)
        }
    }
    template hole slit(length = 10) {
        gap = slot(length: length, width: 2)
    }
    left  = bolt(size: 5) at (-40, 0) rotated 90deg
    right = bolt(head: 12, size: 7)
    shelf[0] = plate() at (0, 50)
    shelf[1] = plate(w: 80)
    solid door {
        panel = rectangle(width: 50, height: 40)
        handle = slit(length: 12)
        constrain handle.centered_in(panel)
    }
    constrain {
        right.right_of(shelf[0], gap: 3)
        shelf[1].above(shelf[0], gap: 8)
        centered_horizontally(shelf[1], shelf[0])
        door.below(shelf, gap: 6)
        left.left_of(door, gap: 2)
        right.top.center.y == shelf[0].sheet.top
    }
}
