// A pipe with a slanted branch.
$fn = 96;
difference() {
  union() {
    cylinder(r = 12, h = 80, center = true);
    rotate([0, 60, 0]) cylinder(r = 9, h = 45);
  }
  cylinder(r = 9, h = 90, center = true);
  rotate([0, 60, 0]) cylinder(r = 6, h = 60);
}
