#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit length
};

struct RayHit {
  double range;            ///< from the ray's origin
  Eigen::Vector3d normal;  ///< surface normal, unit length, against the ray
};

/// The first triangle along a ray and the nearest to a point, by Embree in single precision. Hit and distance are
/// recomputed in double, right to the last bits on any instruction set. The mesh must outlive the caster.
class RayCaster {
 public:
  /// O(n log n). @throws Error when Embree cannot be set up.
  explicit RayCaster(const TriangleMesh& mesh);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;
  RayCaster(RayCaster&&) = delete;
  RayCaster& operator=(RayCaster&&) = delete;

  /// Absent if the ray hits nothing. Thread-safe. O(log n)
  [[nodiscard]] std::optional<RayHit> first_hit(const Ray& ray) const;
  /// To the nearest point of any triangle; infinite for an empty mesh. Thread-safe. O(log n)
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;

 private:
  struct EmbreeScene;
  struct NearestTriangle;

  [[nodiscard]] std::optional<RayHit> hit_on(std::size_t triangle, const Ray& ray) const;

  const TriangleMesh* mesh_;
  /// Embree sees the mesh centred and with radius 1, where single precision is finest.
  Eigen::Vector3d middle_;
  double radius_;
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace cloud2csg
