// An open box with rounded corners and two holes in its floor.
$fn = 96;
module prism(radius) {
  hull() for (x = [8, 72], y = [8, 42]) translate([x, y, 0]) cylinder(r = radius, h = 25);
}
difference() {
  prism(8);
  translate([0, 0, 3]) prism(5);
  for (x = [20, 60]) translate([x, 25, -1]) cylinder(r = 4, h = 10, $fn = 64);
}
