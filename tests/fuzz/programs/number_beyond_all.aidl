solid zigzag { edge = path(from: (0, 1e308), polyline_to([(10, 10)])) }
