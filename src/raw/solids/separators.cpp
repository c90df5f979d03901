#include "raw/solids/separators.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/geometry/cubes.hpp"

namespace cloud2csg {
namespace {

/// Places inside the written solid, by their index.
struct InsidePlaces {
  std::vector<std::uint32_t> right, wrong;
  AlignedBox box;
  double spacing;  ///< of all places, inside or not
};

InsidePlaces places_inside(const WrittenSolids& written, const LabelledPlaces& places) {
  const std::vector<double> values = implicit_value(written.tree, written.solids, places.positions);
  InsidePlaces inside{.right = {},
                      .wrong = {},
                      .box = {},
                      .spacing = std::cbrt(bounds_of(places.positions).volume() / static_cast<double>(values.size()))};
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    if (!(values[i] < 0)) continue;
    (places.weights[i] < 0 ? inside.wrong : inside.right).push_back(i);
    inside.box.extend(places.positions[i]);
  }
  return inside;
}

/// Groups of wrong places: those in touching cubes of an edge of two spacings.
std::vector<std::vector<std::uint32_t>> lumps_of(const InsidePlaces& inside, const LabelledPlaces& places) {
  std::vector<std::uint64_t> cubes;
  for (const std::uint32_t i : inside.wrong)
    cubes.push_back(cube_of(places.positions[i] - inside.box.center(), 2 * inside.spacing));
  std::vector<std::vector<std::uint32_t>> lumps = connected_groups(cubes);
  for (std::vector<std::uint32_t>& lump : lumps) {
    for (std::uint32_t& k : lump) k = inside.wrong[k];
  }
  return lumps;
}

/// Logistic regression in a frame in which the solid's diagonal is one: the chance that a place belongs to the lump is
/// 1 / (1 + exp(-factors . (x, y, z, 1))). Both sides weigh the same.
struct Regression {
  Eigen::Matrix4d curvature = Eigen::Matrix4d::Zero();
  Eigen::Vector4d slope = Eigen::Vector4d::Zero();

  explicit Regression(const Eigen::Vector4d& factors) {
    // Keeps the factors finite where a plane separates the sides, and the plane in the middle between them.
    constexpr double k_ridge = 1e-4;
    curvature.diagonal().setConstant(k_ridge);
    slope = k_ridge * factors;
  }

  void add(const Eigen::Vector3d& place, bool is_lump, double weight, const Eigen::Vector4d& factors) {
    const Eigen::Vector4d terms(place.x(), place.y(), place.z(), 1);
    const double chance = 1 / (1 + std::exp(-terms.dot(factors)));
    slope += weight * (chance - (is_lump ? 1 : 0)) * terms;
    curvature += weight * chance * (1 - chance) * terms * terms.transpose();
  }
};

/// The plane that best separates a lump from the right places, by Newton's method. Absent if no direction does.
std::optional<Surface> plane_below(const std::vector<std::uint32_t>& lump, const InsidePlaces& inside,
                                   const LabelledPlaces& places) {
  constexpr int k_most_newton_steps = 30;
  constexpr double k_longest_step = 10;  // else the first steps may overshoot
  const Eigen::Vector3d middle = inside.box.center();
  const double diagonal = inside.box.diagonal().norm();
  const auto in_frame = [&](std::uint32_t i) -> Eigen::Vector3d { return (places.positions[i] - middle) / diagonal; };
  Eigen::Vector4d factors = Eigen::Vector4d::Zero();
  for (int step = 0; step < k_most_newton_steps; ++step) {
    Regression regression(factors);
    for (const std::uint32_t i : lump) {
      regression.add(in_frame(i), true, 1 / static_cast<double>(lump.size()), factors);
    }
    for (const std::uint32_t i : inside.right) {
      regression.add(in_frame(i), false, 1 / static_cast<double>(inside.right.size()), factors);
    }
    const Eigen::Vector4d way = regression.curvature.ldlt().solve(regression.slope);
    if (way.norm() < 1e-6 * factors.norm()) break;
    factors -= way * (k_longest_step / std::max(way.norm(), k_longest_step));
  }
  const double length = factors.head<3>().norm();
  if (!(length > 0)) return std::nullopt;
  const Eigen::Vector3d normal = factors.head<3>() / length;
  return Surface{
      .type = SurfaceType::plane, .position = middle - factors[3] / length * diagonal * normal, .axis = normal};
}

}  // namespace

std::vector<Surface> separating_planes(const WrittenSolids& written, const LabelledPlaces& places, double least_weight,
                                       const RunContext& run) {
  const InsidePlaces inside = places_inside(written, places);
  std::vector<Surface> planes;
  if (inside.wrong.empty() || inside.right.empty() || !(inside.spacing > 0)) return planes;
  for (const std::vector<std::uint32_t>& lump : lumps_of(inside, places)) {
    double weight = 0;
    for (const std::uint32_t i : lump) weight -= places.weights[i];
    if (!(weight >= least_weight) || run.stop.stop_requested()) continue;
    if (const auto plane = plane_below(lump, inside, places)) planes.push_back(*plane);
  }
  return planes;
}

}  // namespace cloud2csg
