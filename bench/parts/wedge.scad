// A wedge with two holes.
$fn = 64;
difference() {
  rotate([90, 0, 0]) linear_extrude(30) polygon([[0, 0], [50, 0], [50, 10], [10, 35], [0, 35]]);
  translate([30, -15, -1]) cylinder(r = 5, h = 40);
  translate([-1, -15, 22]) rotate([0, 90, 0]) cylinder(r = 4, h = 30);
}
