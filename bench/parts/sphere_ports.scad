// A hollow ball with six ports.
module crossed(radius, length) {
  for (turn = [[0, 0, 0], [90, 0, 0], [0, 90, 0]]) rotate(turn) cylinder(r = radius, h = length, center = true, $fn = 96);
}
difference() {
  union() {
    sphere(r = 25, $fn = 128);
    crossed(9, 70);
  }
  sphere(r = 21, $fn = 128);
  crossed(6, 80);
}
