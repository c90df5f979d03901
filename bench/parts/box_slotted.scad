// A housing with rows of slots in two walls, open above.
difference() {
  cube([80, 50, 30]);
  translate([3, 3, 3]) cube([74, 44, 30]);
  for (x = [14 : 8 : 66]) translate([x, -1, 8]) cube([4, 52, 14]);
}
