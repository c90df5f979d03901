// A gear of 24 trapezoid teeth with round tips and roots.
linear_extrude(height = 8) difference() {
  intersection() {
    union() {
      circle(r = 32, $fn = 256);
      for (i = [0 : 23]) rotate(15 * i) polygon([[30, -2.6], [38, -1.2], [38, 1.2], [30, 2.6]]);
    }
    circle(r = 36, $fn = 256);
  }
  circle(r = 10, $fn = 96);
}
