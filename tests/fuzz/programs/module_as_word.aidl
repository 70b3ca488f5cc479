solid s { t = text("HH", height: 5, align: math) }
