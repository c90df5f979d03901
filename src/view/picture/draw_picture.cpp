#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"
#include "core/base/parallel.hpp"
#include "shape/mesh/model_extent.hpp"
#include "view/picture/draw_solid.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Disc radius in samples: 0.6 of the point spacing for points spread over the surface of their bounding box.
double disc_radius(const AlignedBox& box, std::size_t points, double step) {
  const Vector3d s = box.sizes();
  const double area = 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  constexpr double k_least = 1.1;  // a third of a pixel
  constexpr double k_most = 6;
  return std::clamp(0.6 * std::sqrt(area / static_cast<double>(points)) / step, k_least, k_most);
}

/// Draws a disc around (x, y) samples, hidden by nearer samples.
void draw_disc(Samples& samples, const View& view, double x, double y, double radius, const Sample& disc) {
  const auto first = [radius](double middle) { return std::max(0.0, std::ceil(middle - radius)); };
  for (double row = first(y); row <= y + radius && row < static_cast<double>(view.rows); ++row) {
    for (double column = first(x); column <= x + radius && column < static_cast<double>(view.columns); ++column) {
      if (std::hypot(row - y, column - x) > radius) continue;
      Sample& sample = samples[static_cast<std::size_t>(row) * view.columns + static_cast<std::size_t>(column)];
      if (disc.depth < sample.depth) sample = disc;
    }
  }
}

/// Draws points as opaque discs, large enough to close most gaps. Shades them by normals, where present, and fades them
/// with distance. Without `colours` all are grey. O(points x samples of a disc)
Samples draw_cloud(const PointCloud& cloud, std::span<const Colour> colours, const View& view) {
  Samples samples(view.columns * view.rows);
  const AlignedBox box = bounds_of(cloud.positions);
  const double radius = disc_radius(box, cloud.size(), view.step);
  const double nearest = (box.center() - view.corner).dot(view.forward) - 0.5 * box.diagonal().norm();
  const double depth_of_box = std::max(box.diagonal().norm(), 1e-300);
  const Vector3f plain = linear_colour({.red = 72, .green = 92, .blue = 128});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d place = cloud.positions[i] - view.corner;
    const double depth = place.dot(view.forward);
    // Points that face away show through gaps and on open surfaces: pale, to tell the sides of a surface apart.
    const Vector3d normal = cloud.has_normals() ? cloud.normals[i] : Vector3d(-view.forward);
    const bool is_behind = normal.dot(view.forward) > 0;
    const Vector3d facing = is_behind ? Vector3d(-normal) : normal;
    const double far = std::clamp((depth - nearest) / depth_of_box, 0.0, 1.0);
    const auto haze = static_cast<float>(is_behind ? 0.7 : 0.25 * far);
    const Vector3f colour = brightness(facing, view) * (colours.empty() ? plain : linear_colour(colours[i]));
    draw_disc(samples, view, place.dot(view.right) / view.step, -place.dot(view.up) / view.step, radius,
              {.depth = static_cast<float>(depth), .colour = (1 - haze) * colour + Vector3f::Constant(haze)});
  }
  return samples;
}

constexpr std::size_t k_oversampling = 3;
// Samples and hits take half a kilobyte per pixel.
constexpr double k_most_pixels = 4e6;

std::uint8_t byte_of(float linear) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::pow(std::clamp(linear, 0.0F, 1.0F), 1 / 2.2F)));
}

/// The part of a picture that begins at a column of pixels.
struct Pane {
  int begin, width;
};

void fill_pane(Image& image, const Pane& pane, const Samples& samples, const PictureOptions& options,
               const RunContext& run) {
  const std::size_t columns = k_oversampling * static_cast<std::size_t>(pane.width);
  for_each_index(static_cast<std::size_t>(image.height), run, [&](std::size_t row) {
    const Colour behind = background(options, static_cast<int>(row));
    const Eigen::Vector3f empty = linear_colour(behind);
    for (std::size_t column = 0; column < static_cast<std::size_t>(pane.width); ++column) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      bool is_empty = true;
      for (std::size_t k = 0; k < k_oversampling * k_oversampling; ++k) {
        const std::size_t sample_row = k_oversampling * row + k / k_oversampling;
        const Sample& sample = samples[sample_row * columns + k_oversampling * column + k % k_oversampling];
        const bool is_seen = std::isfinite(sample.depth);
        sum += is_seen ? sample.colour : empty;
        is_empty = is_empty && !is_seen;
      }
      sum /= static_cast<float>(k_oversampling * k_oversampling);
      const std::size_t pixel =
          row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(pane.begin) + column;
      // Exact background colour instead of a rounded mean.
      const std::array<std::uint8_t, 3> colour = is_empty
                                                     ? std::array{behind.red, behind.green, behind.blue}
                                                     : std::array{byte_of(sum.x()), byte_of(sum.y()), byte_of(sum.z())};
      std::ranges::copy(colour, image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
    }
  });
}

/// Bounding box without outliers, which would make everything else small.
AlignedBox main_box(const PointCloud& cloud) {
  constexpr double k_left_out = 0.002;
  AlignedBox box;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  std::array<const std::vector<double>*, 3> axes{&cloud.positions.x, &cloud.positions.y, &cloud.positions.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values = *axes.at(axis);
    const auto skipped = static_cast<std::ptrdiff_t>(k_left_out * static_cast<double>(values.size()));
    std::ranges::nth_element(values, values.begin() + skipped);
    low[static_cast<Eigen::Index>(axis)] = values[static_cast<std::size_t>(skipped)];
    std::ranges::nth_element(values, values.end() - 1 - skipped);
    high[static_cast<Eigen::Index>(axis)] = *(values.end() - 1 - skipped);
  }
  return {low, high};
}

}  // namespace

std::optional<OptionConflict> conflict_in(const PictureOptions& options) {
  const double width = options.width > 0 ? options.width : 2.0 * options.height;
  if (width * options.height <= k_most_pixels) return std::nullopt;
  return OptionConflict{"height", fmt::format("expected at most {:.0f} pixels with this width, found {}",
                                              k_most_pixels / width, options.height)};
}

Colour background(const PictureOptions& options, int row) {
  const double down = static_cast<double>(row) / std::max(1, options.height - 1);
  const auto between = [down](double top, double bottom) {
    return static_cast<std::uint8_t>(std::lround(top + down * (bottom - top)));
  };
  return {.red = between(253, 229), .green = between(254, 234), .blue = between(255, 241)};
}

Image draw_picture(const Scene& scene, const PictureOptions& options, const RunContext& run) {
  validate(options);
  const bool has_cloud = scene.cloud && scene.cloud->size() > 0;
  TriangleMesh mesh;
  if (scene.model.tree) {
    mesh = mesh_surface(scene.model, model_extent(scene.model), {.resolution = options.resolution}, run);
  }
  AlignedBox box;
  if (!mesh.triangles.empty()) box.extend(bounds_of(mesh.vertices));
  if (has_cloud) box.extend(main_box(*scene.cloud));
  const int panes = (has_cloud ? 1 : 0) + (scene.model.tree ? 1 : 0);
  if (panes == 0 || box.isEmpty()) {
    throw Error({.expected = "expected a cloud or a solid to draw, found neither"});
  }
  Image image{.width = options.width > 0 ? options.width : panes * options.height, .height = options.height};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  Pane pane{.begin = 0, .width = image.width / panes};
  const auto view = [&] {
    return view_of(box, options.azimuth_deg, options.elevation_deg,
                   k_oversampling * static_cast<std::size_t>(pane.width),
                   k_oversampling * static_cast<std::size_t>(image.height));
  };
  if (has_cloud) {
    fill_pane(image, pane, draw_cloud(*scene.cloud, scene.colours, view()), options, run);
    pane = {.begin = pane.width, .width = image.width - pane.width};
  }
  if (scene.model.tree) fill_pane(image, pane, draw_solid(scene.model, mesh, view(), run), options, run);
  return image;
}

void write_picture(const std::filesystem::path& file, const Scene& scene, const PictureOptions& options,
                   const RunContext& run) {
  write_text_file(file, to_png(draw_picture(scene, options, run)));
}

}  // namespace cloud2csg
