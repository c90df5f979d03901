// A flanged bush with an O-ring groove around it and another in its face.
$fn = 128;
rotate_extrude() difference() {
  union() {
    square([20, 40]);
    square([34, 8]);
  }
  translate([-1, -1]) square([11, 42]);
  translate([20, 25]) circle(r = 2.5, $fn = 64);
  translate([27, 8]) circle(r = 2, $fn = 64);
}
