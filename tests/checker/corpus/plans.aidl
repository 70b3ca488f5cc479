/// Empty structures have a box of their own that can be constrained before anything is drawn.
assembly flat {
    solid kitchen { todo }
    solid hall { }
    solid bath { todo }
    constrain {
        kitchen.width == 30
        kitchen.height == 40
        hall.right_of(kitchen, gap: 0)
        same_height(hall, kitchen)
        align_bottom(hall, kitchen)
        hall.width >= 15
        bath.above(hall, gap: 0)
        bath.width <= hall.width
        bath.left == hall.left
        bath.height == 20
    }
}
