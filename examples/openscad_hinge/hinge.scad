// SPDX-License-Identifier: MIT
// A hinge: a frame with a bore, and a flap whose barrel carries the pin that turns in it. Axis x, lengths in mm.
// Run by fettle as the scene says: openscad -o OUT -D 'part="flap"' -D pin_radius=2.9 ... hinge.scad
part = "flap";
pin_radius = 2.9;     // of the flap's pin
bore_radius = 3.0;    // of the frame's bore
wall = 2.5;           // of the frame round the bore
thickness = 3.0;      // of the flap
sides = 32;           // of every circle: 32 sides lie parallel in both parts

module rod(radius, length) { rotate([0, 90, 0]) cylinder(r = radius, h = length, $fn = sides); }

module flap() {
    // barrel between the frame's cheeks, a pin that stands out of it on both sides, and the leaf
    translate([-6, 0, 0]) rod(pin_radius + 1.5, 12);
    translate([-11, 0, 0]) rod(pin_radius, 22);
    translate([-6, 0, -thickness / 2]) cube([12, 20, thickness]);
}

module cheek(x) {
    difference() {
        union() {
            translate([x, 0, 0]) rod(bore_radius + wall, 4);
            translate([x, -(bore_radius + wall), -14]) cube([4, 2 * (bore_radius + wall), 14]);
        }
        translate([x - 1, 0, 0]) rod(bore_radius, 6);
    }
}

module frame() {
    cheek(-11);
    cheek(7);
    translate([-11, -(bore_radius + wall), -17]) cube([22, 2 * (bore_radius + wall), 4]);
}

if (part == "flap") flap(); else frame();
