// A disc with a fully round rim and a bore.
$fn = 128;
rotate_extrude() difference() {
  union() {
    translate([0, -3]) square([37, 6]);
    translate([37, 0]) circle(r = 3, $fn = 64);
  }
  translate([-1, -4]) square([9, 8]);
}
