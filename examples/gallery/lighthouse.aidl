/// A lighthouse on a rock in the sea, with its keeper's cottage: stacked parts, stripes that follow the taper.
assembly lighthouse {
    param tower_height = 150mm in 110..200
    param taper = 0.6 in 0.44..0.76
    param stripes = 3 in 2..5 step 1
    param rays = 4 in 2..6 step 1
    let foot = 62mm
    let head = taper * foot
    let room = 0.74 * head
    let course = tower_height / (2 * stripes + 1)
    @color(tint) @shade(slope)
    solid block(tint = "dimgray", w = 20, h = 4) { v = rectangle(width: w, height: h) }
    @color(tint) @shade(round)
    solid cone(tint = "dimgray", foot = 9, head = 9, h = 9) { v = trapezoid((0, 0), foot, head, h) }
    @color("#fff3c0") @shade("#f2b84b") solid window(w = 8, h = min(13, 0.8 * course)) {
        pane = arch(width: w, height: h)
        drawing bars { v = clip([line((0, -9), (0, 9)), line((-9, 0), (9, 0))], offset(pane, 0)) }
    }
    @color("#16233f") @shade("#b0707a")
    solid sky { v = rectangle(left: -120, right: 160, bottom: -52, top: tower_height + 90) }
    @color("#fbf3d0") @shade("#e0cf9a", 0deg) @stroke(none)
    solid moon { v = crescent((132, tower_height + 62), 15, 13, 8) }
    @color("white") @stroke(none) solid stars {
        v = [star(
            (97 * i * i % 250 - 105, 30 + 61 * i * i % (tower_height + 20)), 2.2, 0.9, 4
        ) for i in 1..16]
    }
    @color("#fff2b0") @stroke(none) assembly light {
        @shade(fade, 0deg) @opacity(0.8) solid beams {
            let ways = [56 / rays * (i - (rays - 1) / 2) for i in 0..<rays]
            v = [strip(origin, polar(108, a), 4, 120 / rays / 1.6) for a in ways]
        }
        left = mirror(beams, about: y_axis)
        @shade(fade) solid glow { v = circle(radius: 34) }
    }
    @color("#7a858e") @shade(slope) solid rock {
        let shore = [(-60, -8), (-46, -5), (-40, 0), (106, 0), (114, -10), (124, -24)]
        body = path((-76, -24), polyline_to(shore), close())
        fillet([body.corner[i] for i in 1..5], 3)
        @color("#566069")
        drawing cracks { v = [zigzag(p, p + (16, -3), 2, 1) for p in [(-50, -11), (50, -6)]] }
    }
    tower = cone("whitesmoke", foot, head, tower_height) at (0, tower_height / 2)
    @color("firebrick") @shade(round) solid paint {
        for i in 1..stripes {
            construction band[i] = rectangle((0, (2 * i - 0.5) * course), foot, course)
            stripe[i] = clip(band[i], by: tower.v)
        }
    }
    for i in 1..<stripes { windows[i] = window() at (0, (2 * i + 0.5) * course) }
    step_ = block("#7a858e", w: 24, h: 3)
    @color("peru") @shade(slope)
    solid door { leaf = arch(width: 13, height: 18); drawing d { v = ribs(leaf, 3.8, width: 0) } }
    gallery = block(w: head + 22, h: 5)
    brackets = cone(foot: head, head: head + 16)
    @color("#565c63") solid railing {
        for i in 0..10 { post[i] = rectangle((4 * i - 20, 0), width: 1.2, height: 12) }
        for i in 0..1 { rail[i] = rectangle((0, 6 * i), width: head + 18, height: 1.4) }
        constrain spread(post, inside: rail[1], axis: x)
    }
    @color("#fff6c4") @shade("#f5c542", 0deg)
    solid lantern { glass = rectangle((0, 0), room, 25); drawing d { v = crosshatch(glass, 7) } }
    eaves = block("firebrick", w: room + 8, h: 3)
    @color("firebrick") @shade(round) solid roof { cap = dome(width: room + 3, height: 16) }
    @color("dimgray") @shade(round)
    solid vane { rod = rectangle((0, 8), width: 1.6, height: 16); ball = circle((0, 3), radius: 3) }
    cottage = block("whitesmoke", w: 50, h: 21)
    chimney = block("#9c6b52", w: 7, h: 14)
    thatch = cone("#c05a40", foot: 58, head: 44, h: 17)
    @color("#7d3022") drawing cover { rows = shingles(thatch.v, width: 6, height: 4) }
    panes = linear_array(window(7, 10), n: 2, pitch: 22)
    @color("#4d7ea8") @shade("#1c3553") solid sea {
        swell = wave((-120, -20), (160, -20), amplitude: 3, waves: 7)
        bed = polyline([swell.end, (160, -52), (-120, -52), swell.start])
    }
    @color("#a9cbe3") @opacity(0.6) drawing foam {
        crest = [wave((x, y), (x + 34, y), 1.6, 2) for x, y in [[-104, -32], [-30, -40], [50, -31]]]
    }
    @color("#fbe3c0") @opacity(0.6) @stroke(none) solid gleam {
        v = [slot((132 + 3 * (-1) ^ i, -28 - 6 * i), 34 - 6 * i, 1.8) for i in 0..3]
    }
    constrain {
        brackets.top == tower.top
        column(vane, roof, eaves, lantern.glass, gallery, tower, gap: 0, align: center)
        railing.on_top_of(gallery, align: center)
        light.origin == lantern.glass.center
        step_.bottom == tower.bottom
        door.leaf.on_top_of(step_, align: center)
        cottage.right_of(tower, gap: 12, align: bottom)
        thatch.stacked_on(cottage)
        chimney.center == thatch.v.top_right + (-9, 2)
        panes.center == cottage.center
    }
}
