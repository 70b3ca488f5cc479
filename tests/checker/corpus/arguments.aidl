/// References passed to templates become unknowns of the instance, tied by equalities.
// changes: base.b
assembly a {
  solid pin(at_point: point = (0, 0), r = 4) { c = circle(center: at_point, radius: r) }
  solid base { b = rectangle(width: 40, height: 10) }
  p = (30, 40)
  one = pin(at_point: p) rotated 90deg
  two = pin(at_point: base.b.top_left, r: base.b.height / 4)
  constrain { one.below(base, gap: 4)  two.r == 3 }
}
