/// A box used together with the box of a descendant leaves that descendant out.
assembly frame {
    solid picture {
        canvas = rectangle(width: 60, height: 40)
        solid caption {
            strip = rectangle(width: 30, height: 6)
        }
        hole hook {
            rim = circle(radius: 3)
        }
        constrain {
            caption.below(self, gap: 2)
            centered_horizontally(caption, picture)
            hook.center_x == canvas.center.x
            hook.top == canvas.bb.top - 2
        }
    }
    solid shelf { board = rectangle(width: 100, height: 5) }
    constrain picture.stacked_on(shelf)
}
