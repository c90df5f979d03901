// A conical nozzle with a flange and a recess below.
$fn = 128;
difference() {
  union() {
    cylinder(r1 = 20, r2 = 10, h = 30);
    translate([0, 0, -10]) cylinder(r = 20, h = 10);
    translate([0, 0, 30]) cylinder(r = 10, h = 12);
    translate([0, 0, -10]) cylinder(r = 28, h = 4);
  }
  translate([0, 0, -11]) cylinder(r = 15, h = 12);
  cylinder(r1 = 15, r2 = 6, h = 30);
  translate([0, 0, 29]) cylinder(r = 6, h = 20);
}
