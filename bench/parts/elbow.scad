// A bent pipe with a flange.
$fn = 64;
module pipe(radius, beyond) {
  rotate_extrude(angle = 90, $fn = 128) translate([30, 0]) circle(r = radius);
  translate([30, beyond, 0]) rotate([90, 0, 0]) cylinder(r = radius, h = 25 + 20 * beyond);
  translate([beyond, 30, 0]) rotate([0, -90, 0]) cylinder(r = radius, h = 25 + 20 * beyond);
}
difference() {
  union() {
    pipe(10, 0);
    translate([30, -25, 0]) rotate([90, 0, 0]) cylinder(r = 18, h = 5);
  }
  pipe(7, 1);
}
