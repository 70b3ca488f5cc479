// The case of examples/finger_box.aidl in OpenSCAD, without the letters: for benchmarks/sweep.py.
length = 120; depth = 80; height = 50; t = 3; kerf = 0.15; gap = 5;

function count(size) = 2 * max(1, floor(size / (3 * t) / 2)) + 1;

// A panel about the origin; kinds of the bottom, right, top and left edge: 0 flat, 1 tabs, 2 notches.
module panel(w, h, kinds) {
    difference() {
        square([w, h], center = true);
        edge(w, h, kinds[0], 0);
        edge(h, w, kinds[1], 90);
        edge(w, h, kinds[2], 180);
        edge(h, w, kinds[3], 270);
    }
}
module edge(along, across, kind, turn) {
    n = count(along);
    pitch = along / n;
    if (kind > 0)
        rotate(turn)
            for (i = [0 : n - 1])
                if (i % 2 == (kind == 1 ? 1 : 0)) {
                    left = i == 0 ? 1 : -kerf / 2;
                    right = i == n - 1 ? 1 : -kerf / 2;
                    translate([-along / 2 + i * pitch - left, -across / 2 - 1]) square([pitch + left + right, t + 1]);
                }
}
module wall() { panel(length, height, [1, 1, 0, 1]); }
module end() {
    difference() {
        panel(depth, height, [1, 2, 0, 2]);
        translate([0, height / 2 - 15])
            hull() { for (s = [-1, 1]) translate([s * (0.4 * depth - 14) / 2, 0]) circle(7, $fn = 96); }
    }
}
panel(length, depth, [2, 2, 2, 2]);
translate([0, -depth / 2 - gap - height / 2]) wall();
translate([0, depth / 2 + gap + height / 2]) wall();
translate([-length / 2 - gap - depth / 2, 0]) end();
translate([length / 2 + gap + depth / 2, 0]) end();
