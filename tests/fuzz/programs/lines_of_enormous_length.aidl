drawing ruler {
    param length = 300mm
    for i in 0..length / 10mm {
        tick[i] = line(fixed((10 * i, 1e12)), fixed((10 * i, 5)))
    }
}