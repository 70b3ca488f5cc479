/// A sailing boat: a hull, a mast on it, a mainsail behind the mast and a jib before it.
assembly sailing_boat {
    @color("saddlebrown")
    solid hull {
        shell = trapezoid(bottom_width: 90, top_width: 140, height: 25)
    }
    @color("dimgray")
    solid mast {
        pole = rectangle(center: (0, 90), width: 4, height: 150)
    }
    @color("ivory")
    solid mainsail {
        cloth = triangle(a: (4, 30), b: (60, 30), c: (4, 155))
    }
    @color("lightblue")
    solid jib {
        cloth = triangle(a: (-4, 30), b: (-45, 30), c: (-4, 130))
    }
    constrain {
        mast.bottom == hull.top - 5
        mast.center_x == hull.center_x - 5
        mainsail.left == mast.right
        mainsail.bottom == hull.top + 8
        jib.right == mast.left
        jib.bottom == mainsail.bottom
    }
}
