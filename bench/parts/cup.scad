// A tapered cup with a thin wall, and its handle.
difference() {
  cylinder(r1 = 25, r2 = 32, h = 70, $fn = 128);
  translate([0, 0, 4]) cylinder(r1 = 22.3, r2 = 29.4, h = 70, $fn = 128);
}
difference() {
  translate([38, 0, 35]) rotate([90, 0, 0]) rotate_extrude($fn = 96) translate([16, 0]) circle(r = 4, $fn = 48);
  cylinder(r1 = 24, r2 = 31, h = 70, $fn = 128);
}
