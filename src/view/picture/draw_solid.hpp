#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"

namespace cloud2csg {

/// A parallel projection of the world onto samples: columns from the left, rows from the top.
struct View {
  Eigen::Vector3d right, up, forward;  ///< unit length; `forward` is away from the camera
  Eigen::Vector3d corner;              ///< where the ray of sample (0, 0) begins, outside of all that is shown
  double step;                         ///< between samples, in units of the world
  std::size_t columns, rows;

  [[nodiscard]] Eigen::Vector3d origin(std::size_t column, std::size_t row) const {
    return corner + step * (static_cast<double>(column) * right - static_cast<double>(row) * up);
  }
};

/// A view of so many samples in whose middle the box is, as large as fits. Precondition: the box is not empty.
[[nodiscard]] View view_of(const AlignedBox& box, double azimuth_deg, double elevation_deg, std::size_t columns,
                           std::size_t rows);

/// What is seen at a sample. Colours are linear from 0 to 1; with no `depth` there is nothing.
struct Sample {
  float depth = std::numeric_limits<float>::infinity();  ///< along `forward`
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};

/// Row by row.
using Samples = std::vector<Sample>;

/// A colour as linear numbers.
[[nodiscard]] Eigen::Vector3f linear_colour(const Colour& colour);

/// How bright a surface with this unit normal is, from 0 to 1: light from over the camera's left shoulder, and a little
/// from the sky.
[[nodiscard]] float brightness(const Eigen::Vector3d& normal, const View& view);

/// The model's solid, whose surface `mesh` is, but for rounding. The model must have a tree. @throws Cancelled
[[nodiscard]] Samples draw_solid(const Model& model, const TriangleMesh& mesh, const View& view, const RunContext& run);

}  // namespace cloud2csg
