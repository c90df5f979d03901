// A rim on three spokes, and a hub with a bore.
$fn = 128;
difference() {
  union() {
    rotate_extrude() translate([40, 0]) circle(r = 5, $fn = 64);
    for (i = [0 : 2]) rotate([0, 90, 120 * i]) cylinder(r = 3, h = 40, $fn = 64);
    translate([0, 0, -8]) cylinder(r = 10, h = 20);
  }
  translate([0, 0, -10]) cylinder(r = 5, h = 40, $fn = 96);
}
