// A cam of tangent arcs with a bore and a keyway.
$fn = 128;
linear_extrude(height = 12) difference() {
  hull() {
    circle(r = 22);
    translate([24, 0]) circle(r = 9);
  }
  circle(r = 8);
  translate([-2, 0]) square([4, 10.5]);
}
