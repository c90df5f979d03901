#include "core/fields/onto_surface.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include "core/geometry/subset.hpp"
#include "core/primitive/sampled_field.hpp"

namespace cloud2csg {

std::vector<bool> move_onto_surface(const Primitive& primitive, double reach, PointCloud& cloud) {
  constexpr int k_most_steps = 30;
  constexpr double k_converged = 1e-12;
  const Points start = cloud.positions;
  std::vector<bool> arrived(cloud.size(), false);
  std::vector<std::size_t> moving(cloud.size());
  std::iota(moving.begin(), moving.end(), std::size_t{0});
  for (int step = 0; step < k_most_steps && !moving.empty(); ++step) {
    const Points places = select_points(cloud.positions, moving);
    const SampledField field = sample_field(primitive, places);
    std::vector<std::size_t> still_moving;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const std::size_t i = moving[k];
      const Eigen::Vector3d slope = field.slopes[k];
      const double square = slope.squaredNorm();
      if (!(square > 0.0)) continue;
      const Eigen::Vector3d move = field.offset(k);
      const Eigen::Vector3d position = places[k] - move;
      if (!((position - start[i]).norm() <= reach)) continue;
      cloud.positions.set(i, position);
      cloud.normals.set(i, slope / std::sqrt(square));
      arrived[i] = move.norm() <= k_converged * (reach + position.norm());
      if (!arrived[i]) still_moving.push_back(i);
    }
    moving = std::move(still_moving);
  }
  return arrived;
}

}  // namespace cloud2csg
