#include "quality/defects.hpp"

#include <algorithm>
#include <utility>

#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/sample.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/subset.hpp"
#include "core/primitive/shape.hpp"
#include "random_solids.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_defect_stream = 0x646566656374;
constexpr double k_noise_of_diagonal = 0.005;
constexpr double k_missing_share = 0.2;
constexpr double k_patch_of_primitive = 0.25;  ///< points in a patch, as a share of the average points of a primitive
constexpr double k_outlier_share = 0.05;
constexpr double k_large_outlier_share = 0.3;
constexpr double k_turned_share = 0.2;
constexpr double k_enlarged = 0.1;  ///< enlargement of the bounds for outliers

double radius_around(const Vector3d& middle, const PointCloud& cloud, double share) {
  std::vector<double> distances(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) distances[i] = (cloud.positions[i] - middle).norm();
  const auto nth = distances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(cloud.size()));
  std::ranges::nth_element(distances, nth);
  return *nth;
}

/// Removes balls that each hold `patch_share` of the points.
PointCloud without_patches(const PointCloud& cloud, double patch_share, RandomStream& random) {
  const auto wanted = static_cast<std::size_t>(k_missing_share * static_cast<double>(cloud.size()));
  std::vector<bool> is_kept(cloud.size(), true);
  for (std::size_t gone = 0; gone < wanted;) {
    const Vector3d middle = cloud.positions[random.below(cloud.size())];
    const double radius = radius_around(middle, cloud, patch_share);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!is_kept[i] || (cloud.positions[i] - middle).norm() > radius) continue;
      is_kept[i] = false;
      ++gone;
    }
  }
  return select_points(cloud, places_where(is_kept));
}

PointCloud with_outliers(PointCloud cloud, double share, RandomStream& random) {
  AlignedBox box = bounds_of(cloud.positions);
  const Vector3d margin = 0.5 * k_enlarged * box.sizes();
  box.extend(Vector3d(box.max() + margin));
  box.extend(Vector3d(box.min() - margin));
  const auto count = static_cast<std::size_t>(static_cast<double>(cloud.size()) * share / (1 - share));
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.push_back(random_between(box.min(), box.max(), random));
    cloud.normals.push_back(random_direction(random));
  }
  return cloud;
}

PointCloud with_turned_normals(PointCloud cloud, RandomStream& random) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (random.chance(k_turned_share)) cloud.normals.set(i, -cloud.normals[i]);
  }
  return cloud;
}

/// A copy shifted by less than half of its smallest width, so that it overlaps the original.
Primitive spurious_copy(const PrimitiveSet& primitives, RandomStream& random) {
  Primitive copy = primitives[random.below(primitives.size())];
  copy.id = "spurious";
  const double half_width = oriented_bounds(copy).half_size.minCoeff();
  copy.shape = scaled(std::move(copy.shape), random.uniform(0.6, 1.4));
  copy.pose.position += half_width * random.uniform(0.3, 0.9) * random_direction(random);
  return copy;
}

PointCloud defective_cloud(const Model& model, Defect defect, const DefectOptions& options, RandomStream& random) {
  SampleOptions sample{.count = options.points, .noise = options.noise, .seed = options.seed};
  if (defect == Defect::noise) {
    sample.noise = k_noise_of_diagonal * bounds_of(model).diagonal().norm();
  }
  PointCloud cloud = sample_surface(model, sample);
  if (defect == Defect::patches) {
    const double patch_share = k_patch_of_primitive / static_cast<double>(model.primitives.size());
    return without_patches(cloud, patch_share, random);
  }
  if (defect == Defect::outliers) return with_outliers(std::move(cloud), k_outlier_share, random);
  if (defect == Defect::many_outliers) return with_outliers(std::move(cloud), k_large_outlier_share, random);
  if (defect == Defect::turned) return with_turned_normals(std::move(cloud), random);
  return cloud;
}

}  // namespace

std::string_view to_string(Defect defect) {
  switch (defect) {
    case Defect::none:
      return "none";
    case Defect::noise:
      return "noise, 0.5 % of the diagonal";
    case Defect::patches:
      return "20 % of the points missing";
    case Defect::outliers:
      return "5 % outliers";
    case Defect::many_outliers:
      return "30 % outliers";
    case Defect::turned:
      return "20 % of the normals turned";
    case Defect::spurious:
      return "a spurious primitive";
    case Defect::missing:
      return "a missing primitive";
  }
  return "";
}

Task make_defective_task(const Model& model, Defect defect, const DefectOptions& options) {
  RandomStream random(options.seed, k_defect_stream);
  PointCloud cloud = defective_cloud(model, defect, options, random);
  Model judged = model;
  if (defect == Defect::spurious) judged.primitives.push_back(spurious_copy(model.primitives, random));
  auto judge = std::make_shared<const Judge>(judged.primitives, *judged.tree);
  Task task = make_task(judged, std::move(cloud), std::move(judge), options.seed);
  if (defect == Defect::missing) {
    const std::size_t gone = random.below(model.primitives.size());
    task.judge_index.erase(task.judge_index.begin() + static_cast<std::ptrdiff_t>(gone));
    task.primitives.clear();
    for (const PrimitiveIndex p : task.judge_index) task.primitives.push_back(model.primitives[p]);
  }
  return task;
}

double iou_of_given(const Model& model, const Task& task) {
  return task.judge->intersection_over_union(restrict_to(*model.tree, task.judge_index));
}

}  // namespace cloud2csg::bench
