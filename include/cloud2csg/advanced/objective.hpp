#pragma once

#include <numbers>
#include <optional>
#include <span>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

/// The objective of the search (section 4.3 of the paper), to be maximised:
///
///   E(t) = sum over points { exp(-d^2) + exp(-theta^2) } - alpha * size(t),
///   d = beta * f_t(s),  theta = gamma * angle between the gradient of f_t at s and the point's normal.
namespace cloud2csg {

struct ObjectiveOptions {
  std::optional<double> alpha = {}, beta = {};
  double gamma = 18.0 / std::numbers::pi;
};
void option_table(OptionsOf<ObjectiveOptions>, auto&& field) {
  using O = ObjectiveOptions;
  field(&O::alpha, "alpha",
        "Cost of a node, in points. The default is the paper's, for the points by which the tree is judged.",
        at_least(0), {.absent = "ln of the number of points"});
  field(&O::beta, "beta",
        "Weight of distances, per unit of length. A point one sigma off counts exp(-1). The paper's 100 is the default "
        "for its models and noise.",
        above(0), {.absent = "1 / the measured noise"});
  field(&O::gamma, "gamma",
        "Weight of angles, per radian. The default is the paper's 18 / pi: a normal 10 degrees off counts exp(-1).",
        above(0));
}

/// The objective's weights for one set of points, with all defaults resolved.
struct Objective {
  double alpha;
  double beta;
  double gamma;
};
[[nodiscard]] Objective resolve(const ObjectiveOptions& options, std::size_t points, double noise);

/// Share of a point in E at signed distance `distance`, with `angle` (radians) between gradient and normal.
[[nodiscard]] double point_score(double distance, double angle, const Objective& objective);

/// E(t) by its definition: walks the tree for each point, in double precision, with the libm exp and acos. The
/// reference for the fast evaluation. O(points x size). `points` are indices into the cloud; the tree's leaves index
/// `primitives`. Signed ranks choose among gradients of equal |value| (see implicit_gradient).
[[nodiscard]] double reference_objective(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                                         std::span<const std::uint32_t> points, const Objective& objective);

}  // namespace cloud2csg
