assembly l{ drawing p0 at (53, 5) {  g1 = slot(start: (3, 8), end: (4, 36), width: 36)}
  drawing p1 at (15, 5) {}
  constrain {  p0.bb.center_x >= p1.right  p1.center_x >= p0.right + 1   p1.stacked_on(p0)
  }
}
