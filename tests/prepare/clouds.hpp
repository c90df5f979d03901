#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"

/// Clouds with known normals, noise and outliers.
namespace cloud2csg::testing_support {

using Eigen::Vector3d;

/// Points on a shipped model, noise as a share of the diagonal, with the exact normals.
inline PointCloud model_cloud(const std::string& name, std::size_t points, double noise = 0.0) {
  const Model model = read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / (name + ".json"));
  PointCloud cloud = sample_surface(model, {.count = points});
  const double sigma = noise * bounds_of(cloud.positions).diagonal().norm();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(7, 1, i);
    const Vector3d offset(random.normal(), random.normal(), random.normal());
    cloud.positions.set(i, cloud.positions[i] + sigma * offset);
  }
  return cloud;
}

/// Points on the faces of a box, as many a unit of area everywhere; turned inward as the wall of a cavity.
inline void add_box(PointCloud& cloud, const Vector3d& low, const Vector3d& high, double density, bool is_cavity,
                    RandomStream& random) {
  const Vector3d size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const auto count = static_cast<std::size_t>(density * size[u] * size[v]);
    for (std::size_t i = 0; i < 2 * count; ++i) {
      Vector3d place = low;
      place[u] += size[u] * random.uniform();
      place[v] += size[v] * random.uniform();
      if (i % 2 == 1) place[axis] = high[axis];
      Vector3d normal = Vector3d::Zero();
      normal[axis] = (i % 2 == 1) != is_cavity ? 1.0 : -1.0;
      cloud.positions.push_back(place);
      cloud.normals.push_back(normal);
    }
  }
}

/// Points on a sphere, evenly by chance.
inline PointCloud sphere_cloud(std::size_t points, double radius, double noise, std::uint64_t seed = 1) {
  RandomStream random(seed);
  PointCloud cloud;
  while (cloud.size() < points) {
    const Vector3d normal = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    cloud.positions.push_back((radius + noise * random.normal()) * normal);
    cloud.normals.push_back(normal);
  }
  return cloud;
}

/// The same cloud in another unit and place.
inline PointCloud moved(PointCloud cloud, double factor, const Vector3d& offset) {
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.positions.set(i, factor * cloud.positions[i] + offset);
  return cloud;
}

inline PointCloud without_normals(PointCloud cloud) {
  cloud.normals = {};
  return cloud;
}

/// Share of normals on the same side as the true ones.
inline double rightly_oriented(const Points& normals, const Points& truth) {
  double right = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) right += normals[i].dot(truth[i]) > 0.0 ? 1.0 : 0.0;
  return right / static_cast<double>(normals.size());
}

}  // namespace cloud2csg::testing_support
