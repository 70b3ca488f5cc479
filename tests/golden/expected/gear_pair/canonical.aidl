/// A reduction gear to be cut from a sheet: a pinion, a wheel with a hole for a crank, and the bar that keeps the two
/// axles at the right distance.
assembly gear_pair {
    param module = 2mm in 1.5..3
    param pinion_teeth = 15 in 12..24
    param wheel_teeth = 30 in 25..60
    param backlash = 0.1mm in 0.05..0.3  // room for the cut and for dirt
    param axle = "m5" in ["m4", "m5"]

    @detached
    solid pinion {
        body = gear(teeth: pinion_teeth, module: module, center: origin)
        bore = screw_hole(axle, fit: "close") at origin
    }

    @detached
    solid wheel {
        body = gear(teeth: wheel_teeth, module: module, center: (50, 0))
        bore = screw_hole(axle, fit: "close") at (50, 0)
        crank = screw_hole(axle) at (60, 0)
        constrain {
            bore.center == body.center
            crank.center == body.center + (body.root_radius - screw(axle).washer, 0)
        }
    }

    constrain {
        meshes(wheel.body, pinion.body, backlash: backlash)
        wheel.body.center.y == pinion.body.center.y
    }

    // The bar lies behind the gears; it is drawn below them, to be cut from the same sheet.
    @detached
    solid bar {
        body = slot(start: (0, -60), end: guess((50, -60)), width: 3 * screw(axle).diameter)
        for i in 0..1 {
            hole pivot[i] {
                rim = clearance_hole(axle, center: (50 * i, -60), fit: "close")
            }
        }
        constrain {
            pivot[0].rim.center == body.start
            pivot[1].rim.center == body.end
        }
    }
    constrain {
        distance(bar.body.start, bar.body.end) == distance(pinion.body.center, wheel.body.center)
        bar.body.start.y == bar.body.end.y
        bar.top == wheel.body.center.y - wheel.body.outer_radius - 5mm
        bar.pivot[0].rim.center.x == pinion.body.center.x
    }

    assert distance(
        bar.pivot[0].rim, bar.pivot[1].rim
    ) == module * (pinion_teeth + wheel_teeth) / 2 + backlash,
        "the bar does not keep the gears apart"
    assert clearance(pinion, wheel) > 0, "the teeth jam"
    assert pinion.body.root_radius - screw(axle).close / 2 >= 2mm,
        "the pinion is too weak around its axle"
}
