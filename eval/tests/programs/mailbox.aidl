/// A mailbox on a post, seen from the side, with a flag and a slot.
assembly mailbox {
    @color("royalblue")
    solid box {
        shell = d_shape(radius: 30, height: 50, angle: 180deg)
        hole slot {
            mouth = rectangle(center: (0, 5), width: 30, height: 4)
        }
        constrain slot.center == shell.bb.center + (0, 2)
    }

    @color("sienna")
    solid post {
        pole = rectangle(width: 12, height: 120)
    }

    @color("red")
    solid flag {
        arm = rectangle(width: 4, height: 30)
        cloth = rectangle(width: 16, height: 10)
        constrain {
            cloth.left == arm.right
            cloth.top == arm.top
        }
    }

    constrain {
        box.bottom == post.top
        post.center_x == box.center_x
        flag.bottom == box.center_y
        flag.left == box.right - 2
    }
}
