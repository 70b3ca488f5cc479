// The desk organiser of organiser.aidl for OpenSCAD: the same parts, with every place worked out by hand.
$fn = 32;

width = 180;
depth = 90;
pens = 4;
wall = 4;
bin_width = (width - 5 * wall) / 2;
bin_height = 38;
pen_diameter = 11;

module rounded(size, radius) {
    hull() {
        for (x = [-1, 1], y = [-1, 1]) {
            translate([x * (size[0] / 2 - radius), y * (size[1] / 2 - radius)])
                circle(r = radius);
        }
    }
}

module slot(length, thick) {
    hull() {
        translate([-(length - thick) / 2, 0])
            circle(d = thick);
        translate([(length - thick) / 2, 0])
            circle(d = thick);
    }
}

module star(outer, inner, points) {
    polygon([
        for (i = [0 : 2 * points - 1])
            let (r = i % 2 == 0 ? outer : inner)
            [r * cos(90 + 180 * i / points), r * sin(90 + 180 * i / points)]
    ]);
}

function bin_x(side) = side * (width / 2 - 2 * wall - bin_width / 2);
bin_y = -depth / 2 + 2 * wall + bin_height / 2;
pen_y = bin_y + bin_height / 2 + wall + pen_diameter / 2;
card_y = pen_y + pen_diameter / 2 + wall + 1.5;

module tray() {
    difference() {
        rounded([width, depth], 10);
        for (side = [-1, 1]) {
            translate([bin_x(side), bin_y])
                rounded([bin_width, bin_height], 5);
        }
        for (i = [0 : pens - 1]) {
            translate([bin_x(-1) + i * (pen_diameter + wall), pen_y])
                circle(d = pen_diameter);
        }
        translate([0, card_y])
            slot(70, 3);
        translate([bin_x(1) + bin_width / 2 - 6, depth / 2]) {
            translate([-6, -9])
                square([12, 9]);
            translate([0, -9])
                circle(r = 6);
        }
    }
}

plate_y = -depth / 2 - 8 - 12;

module plate() {
    translate([0, plate_y]) {
        difference() {
            square([80, 24], center = true);
            for (side = [-1, 1]) {
                translate([side * 34, 0])
                    circle(d = 3.4);
            }
        }
    }
}

module badge() {
    translate([40 + 10 + 15, plate_y + 12 - 15]) {
        difference() {
            circle(r = 15);
            star(9, 4, 5);
        }
    }
}

module clip() {
    translate([-40 - 10 - 8, plate_y + 12 - 25]) {
        translate([-8, 0])
            square([16, 25]);
        circle(r = 8);
    }
}

assert(card_y - 1.5 >= bin_y + bin_height / 2, "the slot for cards meets a bin");
tray();
plate();
badge();
clip();
