/// A bicycle from the side: two equal wheels on the ground, a frame between their hubs, a saddle and a handlebar.
assembly bicycle {
    param wheel_radius = 34 in 20..40
    param wheelbase = 100 in 90..120

    solid tyre_and_hub(r = 34) {
        tyre = ring(center: origin, outer_radius: r, thickness: 3)
        hub = circle(center: origin, radius: 4)
        for i in 0..5 {
            let way = polar(1, 60deg * i)
            spoke[i] = slot(start: fixed(2 * way), end: fixed((r - 1) * way), width: 1)
        }
    }

    rear_wheel = tyre_and_hub(r: wheel_radius) at (0, 34)
    front_wheel = tyre_and_hub(r: wheel_radius) at (100, 34)

    @color("crimson")
    solid frame {
        rear_hub = point(0, 34)
        crank = point(40, 32)
        seat_joint = point(30, 80)
        head = point(82, 78)
        front_hub = point(100, 34)
        chain_stay = slot(start: rear_hub, end: crank, width: 4)
        seat_stay = slot(start: rear_hub, end: seat_joint, width: 3)
        seat_tube = slot(start: crank, end: seat_joint, width: 4)
        top_tube = slot(start: seat_joint, end: head, width: 4)
        down_tube = slot(start: crank, end: head, width: 4)
        fork = slot(start: head, end: front_hub, width: 4)
    }

    @color("black")
    solid saddle {
        post = rectangle(center: (30, 84), width: 3, height: 12)
        seat = tapered_slot(start: (20, 92), end: (40, 92), start_radius: 4, end_radius: 2)
    }

    @color("black")
    solid handlebar {
        stem = slot(start: (82, 78), end: (78, 96), width: 3)
        bar = slot(start: (78, 96), end: (92, 98), width: 4)
    }

    constrain {
        rear_wheel.hub.center == frame.rear_hub
        front_wheel.hub.center == frame.front_hub
        front_wheel.bottom == rear_wheel.bottom
        frame.front_hub.x - frame.rear_hub.x == wheelbase
        saddle.post.bottom.midpoint == frame.seat_joint
        handlebar.stem.start == frame.head
    }
}
