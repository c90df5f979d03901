#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/colour.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

/// Pictures of clouds and solids, without a window or a browser.
namespace cloud2csg {

/// Red, green and blue of each pixel, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb = {};
};

/// What is to be seen: the cloud on the left, the solid on the right, in the same view. What is absent has no half.
struct Scene {
  Model model = {};  ///< without a tree there is no solid
  std::optional<PointCloud> cloud = {};
  std::vector<Colour> colours = {};  ///< of the points, one each; none: all are grey
};

struct PictureOptions {
  int width = 0;  ///< pixels, 4096 at most; 0: so many that each half is a square. In all at most 4 million
  int height = 600;
  /// Where the camera stands, seen from the middle: turned from the x axis towards y, then raised over the xy plane.
  double azimuth_deg = -60, elevation_deg = 25;
  int resolution = 192;  ///< cells along the longest side of the solid's mesh, of which only outlines show any
};

/// @throws Error naming the field when an option is out of range.
void validate(const PictureOptions& options);

/// The colour of a pixel in this row where there is nothing.
[[nodiscard]] Colour background(const PictureOptions& options, int row);

/// A parallel projection, three by three rays a pixel. The solid has the colours of its primitives
/// (primitive_colour()), and lines where these meet, at edges and outlines. The same for any number of threads.
/// O(pixels x primitives near each + points).
/// @throws Error when the scene is empty or an option is out of range; Cancelled
[[nodiscard]] Image draw_picture(const Scene& scene, const PictureOptions& options = {}, const RunContext& run = {});

/// The image as a PNG file's bytes. @throws Error when it has no pixels or cannot be compressed.
[[nodiscard]] std::string to_png(const Image& image);

/// Nothing half-written. @throws as draw_picture(), and when the file cannot be written.
void write_picture(const std::filesystem::path& file, const Scene& scene, const PictureOptions& options = {},
                   const RunContext& run = {});

}  // namespace cloud2csg
