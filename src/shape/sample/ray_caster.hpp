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
  Eigen::Vector3d normal;  ///< of the surface, unit length, against the ray
};

/// The first triangle along rays, and the nearest to points, by Embree. It works in single precision; where exactly the
/// triangle is hit, and how far it is, is computed again in double: right to the last bits whatever Embree's
/// instruction set. The mesh must outlive it.
class RayCaster {
 public:
  /// O(n log n). @throws Error when Embree cannot be set up.
  explicit RayCaster(const TriangleMesh& mesh);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;
  RayCaster(RayCaster&&) = delete;
  RayCaster& operator=(RayCaster&&) = delete;

  /// Absent where the ray hits nothing. May be called from several threads at once. O(log n)
  [[nodiscard]] std::optional<RayHit> first_hit(const Ray& ray) const;
  /// To the nearest point of any triangle; infinite for a mesh without triangles. As first_hit() in threads and time.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;

 private:
  struct EmbreeScene;
  struct NearestTriangle;

  [[nodiscard]] std::optional<RayHit> hit_on(std::size_t triangle, const Ray& ray) const;

  const TriangleMesh* mesh_;
  /// Embree sees the mesh with its middle at the origin and its radius 1, where single precision is finest.
  Eigen::Vector3d middle_;
  double radius_;
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace cloud2csg
