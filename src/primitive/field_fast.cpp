#include "cloud2csg/primitive.hpp"
namespace cloud2csg {
void evaluate_field(const Primitive& primitive, PointsView points, const FieldSpans& out) {
  const std::vector<double> d = signed_distance(primitive, points);
  const Points g = gradient(primitive, points);
  for (std::size_t i = 0; i < d.size(); ++i) {
    out.distance[i] = d[i];
    out.gradient_x[i] = g.x[i];
    out.gradient_y[i] = g.y[i];
    out.gradient_z[i] = g.z[i];
  }
}
}  // namespace cloud2csg
