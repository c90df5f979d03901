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
  Eigen::Vector3d right, up, forward;  ///< unit length; `forward` points away from the camera
  Eigen::Vector3d corner;              ///< origin of the ray of sample (0, 0), outside of everything shown
  double step;                         ///< distance between samples, in world units
  std::size_t columns, rows;

  [[nodiscard]] Eigen::Vector3d origin(std::size_t column, std::size_t row) const {
    return corner + step * (static_cast<double>(column) * right - static_cast<double>(row) * up);
  }
};

/// A view in which the box is centred and as large as fits. Precondition: the box is not empty.
[[nodiscard]] View view_of(const AlignedBox& box, double azimuth_deg, double elevation_deg, std::size_t columns,
                           std::size_t rows);

/// A sample with linear colours from 0 to 1; without a `depth` it is empty.
struct Sample {
  float depth = std::numeric_limits<float>::infinity();  ///< along `forward`
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};

/// Row by row.
using Samples = std::vector<Sample>;

/// Converts a colour to linear values.
[[nodiscard]] Eigen::Vector3f linear_colour(const Colour& colour);

/// Brightness of a surface from 0 to 1: light from over the camera's left shoulder and some from the sky.
[[nodiscard]] float brightness(const Eigen::Vector3d& normal, const View& view);

/// Draws the model's solid. `mesh` is its surface up to rounding. The model must have a tree. @throws Cancelled
[[nodiscard]] Samples draw_solid(const Model& model, const TriangleMesh& mesh, const View& view, const RunContext& run);

}  // namespace cloud2csg
