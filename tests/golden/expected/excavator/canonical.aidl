/// An excavator with a ram, and a hose that follows.
@stroke(0.4mm)
assembly excavator {
    param track = 190 in 160..240
    param lift = 42deg in 30deg..55deg
    param paint = "#e2a72e"
    let dark = "#2e3033"
    let steel = "#7a7f84"

    @color(dark) @rigid solid tracks {
        belt = slot(length: track, width: 46)
        @color(steel) @shade(ball)
        hubs = linear_array(circle(10), n: 5, pitch: (track - 46) / 4)
        @color(steel) @stroke(3mm) @dash(7, 5) drawing tread { edge = offset(belt, -3) }
    }
    @color(paint) @shade(slope) solid house {
        shell = path(
            (-70, 0), right(130), up(34), line_to(50, 52), left(90), line_to(-70, 44), close()
        )
        @color(dark) drawing details {
            vents = hatching(rectangle((-52, 26), 24, 22), pitch: 4)
            name = text("AX 30", (0, 26), 11)
        }
    }
    @color(darker(paint)) @shade(slope) @rigid solid cab {
        frame = rounded_rectangle(width: 52, height: 62, radius: 5)
        @color("#d5e4e8") @shade("#86a3ae")
        pane = rounded_rectangle(left: -20, right: 20, bottom: -5, top: 25, radius: 3)
    }
    @color(paint) @shade(slope) solid boom {
        construction way = polyline(
            [(0, 0), polar(95, lift), polar(95, lift) + polar(85, lift - 50deg)]
        )
        arm = thick(way, 18, joins: round)
        @color(steel) @shade(ball) pins = rivets(way, n: 3, inset: 0, diameter: 8)
    }
    @color(paint) @shade(round) solid stick {
        construction way = line((0, 0), length: 120, angle: -105deg)
        arm = strip(way.start, way.end, start_width: 12, end_width: 11)
        @color(steel) @shade(ball) pin = circle(between(way.start, way.end, 0.2), 5)
    }
    @color(steel) @shade(slope) solid bucket {
        bowl = path(
            (0, 0),
            line_to(-34, 4),
            smooth_to((-18, -38)),
            zigzag_to((6, -42), 3, teeth: 4),
            close()
        )
    }
    constrain {
        tracks.belt.center == (0, 0)
        house.bottom == tracks.belt.top
        house.center_x == tracks.center_x
        cab.frame.bottom_right == house.shell.corner[3]
        boom.way.start == house.shell.corner[1] + (-8, 26)
        stick.pin.center == boom.way.end
        bucket.bowl.start == stick.way.end
    }
    @color(lighter(steel)) solid hydraulics {
        lifting = ram(
            house.shell.corner[1].up(6),
            between(boom.way.start, boom.way.corners[1], 0.7),
            barrel: 10
        )
        @color(dark) supply = hose(
            house.shell.corner[2], boom.way.corners[1], 3, leaving: 80deg, arriving: -20deg
        )
    }
}
