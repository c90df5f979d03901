// A stepped shaft with a keyway and a bore.
difference() {
  union() {
    cylinder(r = 10, h = 30, $fn = 96);
    translate([0, 0, 30]) cylinder(r = 15, h = 40, $fn = 96);
    translate([0, 0, 70]) cylinder(r = 8, h = 25, $fn = 96);
  }
  translate([-2.5, 11, 40]) cube([5, 10, 20]);
  translate([0, 0, 90]) cylinder(r = 2.5, h = 10, $fn = 64);
}
