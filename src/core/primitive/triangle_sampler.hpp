#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Draws points from triangles, uniformly by area.
class TriangleSampler {
 public:
  explicit TriangleSampler(std::vector<Triangle> triangles);
  /// Of a mesh: `corners` are places in `vertices`.
  TriangleSampler(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners);

  struct Draw {
    Eigen::Vector3d position;
    std::size_t triangle;
  };
  /// Precondition: area() > 0. O(log triangles)
  [[nodiscard]] Draw draw(RandomStream& random) const;

  [[nodiscard]] double area() const { return cumulative_area_.empty() ? 0.0 : cumulative_area_.back(); }
  /// By the winding; zero for a triangle without area, which is never drawn.
  [[nodiscard]] Eigen::Vector3d normal(std::size_t triangle) const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<double> cumulative_area_;
};

}  // namespace cloud2csg
