// A sheet of 2 mm, bent twice by 90 degrees around an inner radius of 3, with two holes.
$fn = 96;
module quarter() {
  intersection() {
    difference() {
      circle(r = 5);
      circle(r = 3);
    }
    square(5);
  }
}
difference() {
  rotate([90, 0, 0]) linear_extrude(height = 40) {
    square([30, 2]);
    translate([30, 5]) rotate(-90) quarter();
    translate([33, 5]) square([2, 20]);
    translate([38, 25]) rotate(90) quarter();
    translate([38, 28]) square([25, 2]);
  }
  translate([15, -20, -1]) cylinder(r = 5, h = 4);
  translate([50, -20, 27]) cylinder(r = 4, h = 4);
}
