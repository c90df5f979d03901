// A plate with four countersunk holes and a blind one.
$fn = 64;
difference() {
  cube([50, 50, 8]);
  for (x = [12, 38], y = [12, 38]) translate([x, y, 0]) {
    translate([0, 0, -1]) cylinder(r = 3, h = 10);
    translate([0, 0, 4.5]) cylinder(r1 = 3, r2 = 6.5, h = 3.501);
  }
  translate([25, 25, 4]) cylinder(r = 8, h = 10, $fn = 96);
}
