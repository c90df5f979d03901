#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloud2csg/advanced/refine.hpp"
#include "core/base/random.hpp"
#include "core/base/run.hpp"
#include "measure.hpp"
#include "pipeline/refine/slots.hpp"
#include "quality/parts.hpp"
#include "random_solids.hpp"

namespace cloud2csg::bench {
namespace {

constexpr double k_share = 0.01;
constexpr double k_angle = std::numbers::pi / 180;
constexpr std::size_t k_points_refined = 20'000;
constexpr std::size_t k_most_seeds = 10;

/// Displaces each value by up to a share of the size, and turns the primitive.
Primitive shaken(const Primitive& primitive, RandomStream& random) {
  const LocalFrame frame{.orientation = primitive.pose.orientation, .origin = primitive.pose.position};
  const double size = 2 * oriented_bounds(primitive).half_size.maxCoeff();
  std::vector<double> values;
  for (const Slot& slot : slots_of(primitive, frame)) {
    values.push_back(slot.value + random.uniform(-k_share, k_share) * size);
  }
  Primitive result = with_slots(primitive, frame, values).value_or(primitive);
  const Eigen::AngleAxisd turn(k_angle, random_direction(random));
  result.pose.orientation = Eigen::Quaterniond(turn) * result.pose.orientation;
  return result;
}

/// Errors of exact points from the tree's surface, and of the primitives' axes from the true ones.
struct Errors {
  double rms = 0, p99 = 0, axis_deg = 0;
};

Errors errors_of(const Model& model, const PrimitiveSet& primitives, const PointCloud& exact) {
  std::vector<double> distances = implicit_value(*model.tree, primitives, exact.positions);
  double squares = 0;
  for (double& distance : distances) {
    distance = std::abs(distance);
    squares += distance * distance;
  }
  std::ranges::sort(distances);
  double angles = 0;
  double count = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    if (has_no_orientation(primitives[p])) continue;
    const Eigen::Vector3d axis = primitives[p].pose.orientation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d truth = model.primitives[p].pose.orientation * Eigen::Vector3d::UnitZ();
    angles += std::atan2(axis.cross(truth).norm(), axis.dot(truth)) / k_angle;
    count += 1;
  }
  return {.rms = std::sqrt(squares / static_cast<double>(distances.size())),
          .p99 = distances[distances.size() * 99 / 100],
          .axis_deg = angles / std::max(count, 1.0)};
}

std::vector<TableCell> row_of(const char* name, bool regularise, std::size_t seeds, int threads) {
  const Model model = shipped_model(name);
  const PointCloud exact = sample_surface(model, {.count = k_points_refined, .seed = 1000});
  Errors before;
  Errors after;
  double worst = 0;
  std::vector<double> milliseconds;
  const auto share = 1 / static_cast<double>(seeds);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    RandomStream random(seed);
    PrimitiveSet given;
    for (const Primitive& primitive : model.primitives) given.push_back(shaken(primitive, random));
    const PointCloud cloud = paper_cloud(model, k_points_refined, seed);
    const Stopwatch watch;
    const Refinement result =
        refine_primitives(cloud, given, *model.tree, {.regularise = regularise}, {.threads = threads});
    milliseconds.push_back(1e3 * watch.seconds());
    const Errors was = errors_of(model, given, exact);
    const Errors is = errors_of(model, result.primitives, exact);
    before = {before.rms + share * was.rms, before.p99 + share * was.p99, before.axis_deg + share * was.axis_deg};
    after = {after.rms + share * is.rms, after.p99 + share * is.p99, after.axis_deg + share * is.axis_deg};
    worst = std::max(worst, is.rms / was.rms);
  }
  std::ranges::sort(milliseconds);
  return {std::string(name),
          std::string(regularise ? "yes" : "no"),
          fmt::format("{:.5f}", before.rms),
          fmt::format("{:.5f}", after.rms),
          fmt::format("{:.2f}", worst),
          fmt::format("{:.4f}", before.p99),
          fmt::format("{:.4f}", after.p99),
          fmt::format("{:.2f}", before.axis_deg),
          fmt::format("{:.2f}", after.axis_deg),
          fmt::format("{:.0f}", milliseconds[milliseconds.size() / 2])};
}

}  // namespace

void print_refinement(const QualityOptions& options) {
  const std::size_t seeds = std::min(options.seeds, k_most_seeds);
  Table table{
      .name = "refine",
      .title = "Refinement",
      .note = fmt::format("Every value of every primitive off by up to 1 % of its size, every pose by 1 degree; "
                          "{} points, noise 0.01; means over {} seeds.\nrms, 99 %: distances of exact points "
                          "from the true tree's surface over the primitives, before and after; worst: largest "
                          "rms after / before.\naxis: mean angle between axes and the true ones, in degrees.",
                          k_points_refined, seeds),
      .columns = {"model", "regular", "rms", "refined", "worst", "99 %", "refined", "axis", "refined", "ms"}};
  for (const char* name : {"m0", "m1", "m2", "m3"}) {
    for (const bool regularise : {true, false}) {
      table.rows.push_back(row_of(name, regularise, seeds, options.run.threads));
    }
  }
  fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
