solid plate { body = rectangle(center: fixed((0, 0)), 60, 40) chamfer(body, 70) }
