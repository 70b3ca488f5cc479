/// A crank-rocker: a crank that turns all the way round swings a rocker to and fro. Links of plywood for a laser, on pins of
/// dowel; the base lies at the bottom, crank and rocker above it, the coupler above them.
assembly linkage {
    param turn = 60deg in 0..360             // of the crank, from the line between the pivots
    param crank_length = 40mm in 20..50      // all lengths are from hole to hole
    param coupler_length = 110mm in 90..130
    param rocker_length = 80mm in 70..100
    param base_length = 100mm in 90..120
    param pin = 6mm in 4..8
    param play = 0.2mm in 0..0.5             // by which a hole is wider than its pin
    let thickness = 3mm
    let broad = pin + 12mm
    let hole_size = pin + play
    let lengths = [crank_length, coupler_length, rocker_length, base_length]

    /// A bar with a hole at each end.
    @material("birch plywood")
    @thickness(thickness)
    solid bar(reach) {
        outline = slot(start: fixed((0, 0)), end: fixed((reach, 0)), width: broad)
        hole near at fixed((0, 0)) { rim = circle(center: origin, diameter: hole_size) }
        hole far at fixed((reach, 0)) { rim = circle(center: origin, diameter: hole_size) }
    }

    @material("beech dowel")
    @color("burlywood")
    @layer("pins")
    @detached // it has play in its holes
    @thickness(2 * thickness)
    solid dowel() { rod = circle(center: origin, diameter: pin) }

    @color("gainsboro")
    @layer("base")
    base = bar(reach: base_length) at fixed((0, 0))

    @color("sandybrown")
    @layer("crank and rocker")
    @elevation(thickness)
    crank = bar(reach: crank_length) at (0, 0) rotated turn

    @color("sandybrown")
    @layer("crank and rocker")
    @elevation(thickness)
    rocker = bar(reach: rocker_length) at (base_length, 0) rotated guess(100deg)

    @color("goldenrod")
    @layer("coupler")
    @elevation(2 * thickness)
    coupler = bar(reach: coupler_length) at (20, 30) rotated guess(20deg)

    // Two pins hold base and link, two hold link and coupler.
    crank_pivot = dowel() at (0, 0)
    rocker_pivot = dowel() at (base_length, 0)
    @elevation(thickness)
    crank_pin = dowel() at (20, 30)
    @elevation(thickness)
    rocker_pin = dowel() at (90, 70)

    constrain {
        crank.near.rim.center == base.near.rim.center
        rocker.near.rim.center == base.far.rim.center
        coupler.near.rim.center == crank.far.rim.center
        coupler.far.rim.center == rocker.far.rim.center
        crank_pivot.rod.center == base.near.rim.center
        rocker_pivot.rod.center == base.far.rim.center
        crank_pin.rod.center == crank.far.rim.center
        rocker_pin.rod.center == rocker.far.rim.center
    }

    assert crank_length + max(lengths) <= sum(lengths) / 2, "the crank cannot turn all the way round"
    assert distance(coupler.far.rim.center, rocker.far.rim.center) <= 0.001mm, "the linkage does not close"
    assert rocker.far.rim.center.y > 0, "the rocker has gone over to the other side"
    assert clearance(crank, rocker) >= 1mm, "the crank hits the rocker, which lies in its plane"
}
