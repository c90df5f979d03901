#include "core/primitive/sampled_field.hpp"

namespace cloud2csg {

SampledField sample_field(const Primitive& primitive, PointsView points) {
  SampledField field{.distances = std::vector<double>(points.size()), .slopes = Points(points.size())};
  evaluate_field(primitive, points,
                 {.distance = field.distances,
                  .gradient_x = field.slopes.x,
                  .gradient_y = field.slopes.y,
                  .gradient_z = field.slopes.z});
  return field;
}

}  // namespace cloud2csg
