// A thin plate with three slots.
$fn = 64;
difference() {
  cube([100, 60, 4]);
  for (y = [15, 30, 45]) hull() for (x = [20, 80]) translate([x, y, -1]) cylinder(r = 4, h = 6);
}
