#include "view/report/cloud_sections.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/geometry/subset.hpp"
#include "view/report/light_mesh.hpp"

namespace cloud2csg {
namespace {

std::uint16_t half_bits(double value) {
  return Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(static_cast<float>(value)));
}

double sign_of(double value) {
  return value < 0 ? -1.0 : 1.0;
}

}  // namespace

OctahedralNormal octahedral(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d n = direction / std::max(direction.cwiseAbs().sum(), 1e-300);
  Eigen::Vector2d square = n.head<2>();
  if (n.z() < 0) {
    square = {(1 - std::abs(n.y())) * sign_of(n.x()), (1 - std::abs(n.x())) * sign_of(n.y())};
  }
  const auto step = [](double x) {
    return static_cast<std::uint8_t>(std::lround((std::clamp(x, -1.0, 1.0) + 1) / 2 * 255));
  };
  return {.u = step(square.x()), .v = step(square.y())};
}

Payload::Json cloud_sections(const PointCloud& cloud, const Deviation& deviation, std::size_t most, Payload& payload) {
  constexpr PrimitiveIndex k_most_owners = 65'534;
  const std::vector<std::uint32_t> shown = some_of(deviation.order, most);
  const PointCloud points = select_points(cloud, shown);
  const AlignedBox box = bounds_of(points.positions);
  const double largest = std::max({std::abs(deviation.summary.least), std::abs(deviation.summary.greatest), 1e-300});
  std::vector<std::uint16_t> distances;
  std::vector<std::uint16_t> owners;
  for (const std::uint32_t i : shown) {
    distances.push_back(half_bits(deviation.fit.signed_distances[i] / largest));
    const PrimitiveIndex owner = deviation.fit.owners[i];
    owners.push_back(owner > k_most_owners ? std::uint16_t{0} : static_cast<std::uint16_t>(owner + 1));
  }
  std::string normals;
  for (std::size_t i = 0; i < points.normals.size(); ++i) {
    const OctahedralNormal normal = octahedral(points.normals[i]);
    normals += static_cast<char>(normal.u);
    normals += static_cast<char>(normal.v);
  }
  return {{"points", cloud.size()},
          {"shown", shown.size()},
          {"least", {box.min().x(), box.min().y(), box.min().z()}},
          {"greatest", {box.max().x(), box.max().y(), box.max().z()}},
          {"positions", payload.add_differences(quantised(points.positions, box), 3)},
          {"normals", normals.empty() ? Payload::Json(nullptr) : payload.add_bytes(normals)},
          {"distance_unit", largest},
          {"distances", payload.add_plain(distances, 1)},
          {"owners", payload.add_plain(owners, 1)}};
}

}  // namespace cloud2csg
