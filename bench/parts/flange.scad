// A flange with a hub and six bolt holes.
difference() {
  union() {
    cylinder(r = 40, h = 8, $fn = 128);
    cylinder(r = 22, h = 30, $fn = 128);
  }
  translate([0, 0, -1]) cylinder(r = 15, h = 40, $fn = 128);
  for (i = [0 : 5]) rotate(60 * i) translate([32, 0, -1]) cylinder(r = 4, h = 12, $fn = 64);
}
