// A plate with eight fins.
cube([60, 40, 5]);
for (i = [0 : 7]) translate([1 + 8 * i, 0, 4]) cube([2, 40, 20]);
