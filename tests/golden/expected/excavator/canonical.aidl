/// An excavator: tracks, a house with its cab, boom, stick and bucket, the rams that move them, and a hose.
assembly excavator {
    param track = 190 in 160..240
    param lift = 42deg in 30deg..55deg
    param paint = "gold"

    @color("black") @rigid solid tracks {
        belt = slot(length: track, width: 46)
        @color("dimgray") hubs = linear_array(circle(radius: 10), n: 5, pitch: (track - 46) / 4)
        @color("gray") @stroke(3mm) @dash(7, 5) drawing tread { edge = offset(belt, -3) }
    }
    @color(paint) @shade(slope) solid house {
        shell = path(
            (-70, 0), right(130), up(34), line_to(50, 52), left(90), line_to(-70, 44), close()
        )
        @color("black") drawing details {
            vents = hatching(
                rectangle(center: (-52, 26), width: 24, height: 22), pitch: 4, angle: 0deg
            )
            name = text("AX 30", center: (0, 26), height: 11)
        }
    }
    @color(darker(paint)) @rigid solid cab {
        frame = rounded_rectangle(width: 52, height: 62, radius: 5)
        @color("lightcyan")
        pane = rounded_rectangle(left: -20, right: 20, bottom: -5, top: 25, radius: 3)
    }
    @color(paint) @shade(round) solid boom {
        construction way = polyline(
            [(0, 0), polar(95, lift), polar(95, lift) + polar(85, lift - 50deg)]
        )
        arm = thick(way, 18, joins: round)
        @color("dimgray") pins = rivets(way, n: 3, inset: 0, diameter: 8)
    }
    @color(paint) @shade(round) solid stick {
        construction way = line((0, 0), length: 120, angle: -105deg)
        arm = strip(way.start, way.end, start_width: 12, end_width: 11)
        @color("dimgray") pin = circle(center: between(way.start, way.end, 0.2), radius: 5)
    }
    @color("dimgray") @shade(slope) solid bucket {
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
    @color("silver") solid hydraulics {
        lifting = ram(
            house.shell.corner[1].up(6),
            between(boom.way.start, boom.way.corners[1], 0.7),
            barrel: 10
        )
        digging = ram(boom.way.corners[1].up(14), stick.way.start, barrel: 9)
        @color("black") supply = hose(
            house.shell.corner[2], boom.way.corners[1], 3, leaving: 80deg, arriving: -20deg
        )
    }
}
