// A block with a dovetail groove and two long bores.
$fn = 64;
difference() {
  cube([60, 40, 20]);
  translate([-1, 0, 0]) rotate([90, 0, 90]) linear_extrude(70)
    polygon([[14, 20.01], [26, 20.01], [30, 10], [10, 10]]);
  for (x = [15, 45]) translate([x, -1, 5]) rotate([-90, 0, 0]) cylinder(r = 3, h = 50);
}
