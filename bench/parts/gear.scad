// A wheel with twelve teeth and a keyway.
difference() {
  union() {
    cylinder(r = 30, h = 10, $fn = 128);
    for (i = [0 : 11]) rotate(30 * i) translate([28, -3, 0]) cube([8, 6, 10]);
  }
  translate([0, 0, -1]) cylinder(r = 8, h = 20, $fn = 96);
  translate([6, -2, -1]) cube([5, 4, 20]);
}
