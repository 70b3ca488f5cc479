/// Names for expressions over unknowns, in the structure and from outside.
assembly a {
  let shift = 3
  solid b { let inner = c.radius * 2  c = circle(center: (3, 0), radius: 5)  let tip = c.center + (0, c.radius) }
  solid d { c = circle(center: (20, 3), radius: 5) }
  constrain { d.c.center.x == b.tip.x + b.inner + shift
    d.left >= b.right
    if shift > 2 { d.c.radius == b.inner / 2 } else { d.c.radius == 7 }
    prefer d.c.center.y == b.tip.y }
}
