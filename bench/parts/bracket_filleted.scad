// An angle bracket with a fillet inside, a round edge outside, and four bores.
$fn = 96;
difference() {
  rotate([90, 0, 0]) linear_extrude(height = 40) difference() {
    union() {
      translate([10, 10]) circle(r = 10);
      translate([10, 0]) square([50, 8]);
      translate([0, 10]) square([8, 40]);
      square([16, 16]);
    }
    difference() {
      square([10, 10]);
      translate([10, 10]) circle(r = 10);
    }
    translate([16, 16]) circle(r = 8);
    translate([16, 8]) square(60);
    translate([8, 16]) square(60);
  }
  for (y = [-10, -30]) {
    translate([45, y, -1]) cylinder(r = 4, h = 10);
    translate([-1, y, 38]) rotate([0, 90, 0]) cylinder(r = 4, h = 10);
  }
}
