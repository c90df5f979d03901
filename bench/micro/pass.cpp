#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "micro/field_operations.hpp"
#include "micro/work.hpp"
#include "scene.hpp"

/// Class building per point and primitive, and its necessary part: distances and gradients.
namespace cloud2csg::bench {
namespace {

/// Points and fields of a block fit the first-level cache.
constexpr std::size_t k_block = 1024;

// Operations per point and primitive that E(t) and the segmentation need.
/// normal . gradient.
constexpr double k_cosine_operations = 5;
/// |f| <= tolerance and |cosine| >= tolerance.
constexpr double k_member_operations = 5;
/// (beta f)^2.
constexpr double k_exponent_operations = 2;
/// For contributions other than zero: two exponentials to single precision (argument 6, polynomial 12, scale 3), the
/// squared angle from its cosine (polynomial 18, rest 3), their sum for both sides of the surface (3), and one
/// double-width addition of both to the sums of the point's class.
constexpr double k_contribution_operations = 2 * 21 + 21 + 3 + 2;

/// Points in single precision, relative to the cloud's centre.
struct SinglePoints {
  explicit SinglePoints(const Points& points) {
    const Eigen::Vector3d origin = bounds_of(points).center();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f p = (points[i] - origin).cast<float>();
      x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
    }
  }
  std::vector<float> x, y, z;
};

PrimitiveSet moved_to_origin(PrimitiveSet primitives, const Eigen::Vector3d& origin) {
  for (Primitive& primitive : primitives) primitive.pose.position -= origin;
  return primitives;
}

struct FieldBlock {
  alignas(64) std::array<float, k_block> distance, gradient_x, gradient_y, gradient_z;
};

void evaluate_all(const PrimitiveSet& primitives, const SinglePoints& points, FieldBlock& block) {
  for (std::size_t begin = 0; begin < points.x.size(); begin += k_block) {
    const std::size_t count = std::min(k_block, points.x.size() - begin);
    const auto part = [&](const std::vector<float>& values) { return std::span(values).subspan(begin, count); };
    const BasicPointsView<float> view{part(points.x), part(points.y), part(points.z)};
    for (const Primitive& primitive : primitives) {
      evaluate_field(primitive, view,
                     BasicFieldSpans<float>{.distance = std::span(block.distance).first(count),
                                            .gradient_x = std::span(block.gradient_x).first(count),
                                            .gradient_y = std::span(block.gradient_y).first(count),
                                            .gradient_z = std::span(block.gradient_z).first(count)});
    }
  }
}

/// Work per point and primitive: the formulas of distance and gradient, averaged over the primitives.
Work field_work(const Scene& scene) {
  const auto primitives = static_cast<double>(scene.model.primitives.size());
  Work work{.unit = "point x primitive", .units = primitives * static_cast<double>(scene.cloud.size())};
  for (const Primitive& primitive : scene.model.primitives) {
    const OperationCount count = field_operations(primitive);
    work.single_operations += static_cast<double>(count.plain) / primitives;
    work.divisions += static_cast<double>(count.divisions) / primitives;
    work.roots += static_cast<double>(count.roots) / primitives;
  }
  return work;
}

/// Share of point-primitive pairs whose contribution to E(t) is not zero in single precision.
double loud_share(const Scene& scene) {
  const Objective objective = resolve(scene.options.objective, scene.cloud.size(), scene.options.noise);
  constexpr double k_least = 1e-7;
  std::size_t loud = 0;
  for (const Primitive& primitive : scene.model.primitives) {
    const std::vector<double> distance = signed_distance(primitive, scene.cloud.positions);
    const Points slope = gradient(primitive, scene.cloud.positions);
    for (std::size_t i = 0; i < distance.size(); ++i) {
      const double cosine = std::abs(slope[i].dot(scene.cloud.normals[i]));
      loud += point_score(distance[i], std::acos(std::min(cosine, 1.0)), objective) > k_least ? 1 : 0;
    }
  }
  return static_cast<double>(loud) / static_cast<double>(scene.cloud.size() * scene.model.primitives.size());
}

/// Comparisons to sort n numbers: log2(n!).
double sorting_comparisons(std::size_t n) {
  return std::lgamma(static_cast<double>(n) + 1) / std::log(2.0);
}

Work pass_work(const Scene& scene) {
  Work work = field_work(scene);
  const std::size_t primitives = scene.model.primitives.size();
  work.single_operations += k_cosine_operations + k_member_operations + k_exponent_operations +
                            loud_share(scene) * k_contribution_operations +
                            sorting_comparisons(primitives) / static_cast<double>(primitives);
  constexpr std::size_t k_point_bytes = 6 * sizeof(double);
  work.bytes_read = static_cast<double>(k_point_bytes) / static_cast<double>(primitives);
  work.footprint = k_point_bytes * scene.cloud.size();
  return work;
}

}  // namespace

std::vector<Microbenchmark> pass_benchmarks() {
  std::vector<Microbenchmark> all;
  for (const char* name : {"m0", "m2"}) {
    const auto scene = std::make_shared<Scene>(name, k_points);
    const auto points = std::make_shared<SinglePoints>(scene->cloud.positions);
    const auto primitives = std::make_shared<PrimitiveSet>(
        moved_to_origin(scene->model.primitives, bounds_of(scene->cloud.positions).center()));
    const auto block = std::make_shared<FieldBlock>();
    Work fields = field_work(*scene);
    fields.bytes_read = 3 * sizeof(float);
    fields.bytes_written = 4 * sizeof(float);
    fields.footprint = 7 * sizeof(float) * k_block;
    all.push_back({std::string("distances/") + name, fields, [=] { evaluate_all(*primitives, *points, *block); }});
    all.push_back({std::string("class_pass/") + name, pass_work(*scene), [=] {
                     const PointPass pass =
                         build_rank_classes(scene->cloud, scene->model.primitives, scene->requests, scene->options);
                     if (pass.tables.empty()) throw std::logic_error("no table");
                   }});
  }
  return all;
}

}  // namespace cloud2csg::bench
