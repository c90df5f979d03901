// An angle with a gusset and six holes.
$fn = 64;
difference() {
  union() {
    cube([60, 40, 5]);
    cube([5, 40, 50]);
    translate([0, 18, 0]) rotate([90, 0, 0]) mirror([0, 0, 1]) linear_extrude(4) polygon([[5, 5], [45, 5], [5, 40]]);
  }
  for (x = [20, 50], y = [8, 32]) translate([x, y, -1]) cylinder(r = 3, h = 10);
  for (y = [8, 32]) translate([-1, y, 38]) rotate([0, 90, 0]) cylinder(r = 4, h = 10);
}
