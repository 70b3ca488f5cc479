solid s { a = rectangle(center: fixed((123456789.1, 0)), 40, 30) c = cut(a, circle(center: fixed((0, 0)), 4)) }
