// A third of a turned shell.
$fn = 128;
rotate_extrude(angle = 120) intersection() {
  difference() {
    translate([20, 0]) circle(r = 20);
    translate([20, 0]) circle(r = 17);
  }
  translate([20, -12]) square([20, 30]);
}
