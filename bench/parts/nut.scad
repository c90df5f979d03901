// A hexagonal nut without its thread.
difference() {
  cylinder(r = 20, h = 15, $fn = 6);
  translate([0, 0, -1]) cylinder(r = 10, h = 20, $fn = 96);
}
