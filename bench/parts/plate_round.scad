// A plate whose edges are fully round, with two bores.
$fn = 96;
difference() {
  hull() for (x = [4, 76], y = [4, 46]) translate([x, y, 4]) sphere(r = 4);
  for (x = [20, 60]) translate([x, 25, -1]) cylinder(r = 5, h = 10);
}
