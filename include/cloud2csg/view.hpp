#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/extract.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

/// Pictures of clouds and solids, made without a window, and the report: an HTML file with cloud, solid and distances.
namespace cloud2csg {

/// Red, green and blue of each pixel, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb = {};
};

/// Content of a picture: the cloud on the left and the solid on the right, in the same view, if present.
struct Scene {
  Model model = {};  ///< shown as a solid only with a tree
  std::optional<PointCloud> cloud = {};
  std::vector<Colour> colours = {};  ///< one per point; none: all points are grey
};

struct PictureOptions {
  int width = 0, height = 600;
  double azimuth_deg = -60, elevation_deg = 25;
  int resolution = 192;
};
void option_table(OptionsOf<PictureOptions>, auto&& field) {
  using O = PictureOptions;
  constexpr OptionRange k_sides = from_to(16, 4096);
  field(
      &O::width, "width",
      "Width of a .png in pixels; 0: one square for the cloud and one for the solid. At most 4 million pixels in all.",
      OptionRange{.least = k_sides.least, .most = k_sides.most, .takes_zero = true},
      {.unit = "PIXELS", .option = "picture-width"});
  field(&O::height, "height", "Height of a .png in pixels", k_sides, {.unit = "PIXELS", .option = "picture-height"});
  field(&O::azimuth_deg, "azimuth_deg",
        "Direction of the camera as seen from the middle, in degrees from the x axis towards y", from_to(-360, 360),
        {.unit = "DEG"});
  field(&O::elevation_deg, "elevation_deg", "Elevation of the camera above the xy plane, in degrees", from_to(-90, 90),
        {.unit = "DEG"});
  field(&O::resolution, "resolution", "Cells along the longest side of the solid's mesh; only outlines show them",
        from_to(4, 4096), k_library);
}
/// Refuses more than 4 million pixels.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const PictureOptions& options);

/// The background colour of this row of pixels.
[[nodiscard]] Colour background(const PictureOptions& options, int row);

/// A parallel projection with 3 x 3 rays per pixel. The solid has primitive_colour() and lines between primitives, at
/// edges and outlines. Does not depend on threads. O(pixels x primitives near each + points).
/// @throws Error when the scene is empty or an option is out of range; Cancelled
[[nodiscard]] Image draw_picture(const Scene& scene, const PictureOptions& options = {}, const RunContext& run = {});

/// The image as the bytes of a PNG file. @throws Error when it has no pixels or cannot be compressed.
[[nodiscard]] std::string to_png(const Image& image);

/// Never leaves a partial file. @throws as draw_picture(), and when the file cannot be written.
void write_picture(const std::filesystem::path& file, const Scene& scene, const PictureOptions& options = {},
                   const RunContext& run = {});

struct ReportParameter {
  std::string group, name, value;
};

/// A file that the page offers to save.
struct ReportDownload {
  std::string name;  ///< without a folder
  std::string content;
};

/// The content of a report; absent parts do not appear on the page.
struct Report {
  std::string title = {};   ///< e.g. the name of the cloud's file
  std::string source = {};  ///< one line about the origin of the data
  Model model = {};         ///< with a tree
  std::optional<PointCloud> cloud = {};
  std::optional<ExtractStatistics> statistics = {};
  std::vector<ReportParameter> parameters = {};
  std::vector<ReportDownload> downloads = {};
  std::vector<std::string> warnings = {};  ///< in addition to those of the statistics
};

/// Limits on the size of the page. option_table() describes the fields.
struct ReportOptions {
  std::size_t most_points = 100'000;
  int resolution = 128, part_resolution = 64;
  std::size_t most_triangles = 24'000, most_triangles_in_all = 120'000;
  std::size_t most_meshes = 240;
};
void option_table(OptionsOf<ReportOptions>, auto&& field) {
  using O = ReportOptions;
  field(&O::most_points, "most_points",
        "Largest number of points to show; larger clouds are thinned to it, evenly in space. Figures refer to all "
        "points. 100 000 points take about a megabyte.",
        at_least(1));
  field(&O::resolution, "resolution", "Cells along the longest side of the mesh of the whole solid", from_to(4, 4096));
  field(&O::part_resolution, "part_resolution",
        "Cells along the longest side of the meshes of parts; fewer where there are many parts", from_to(4, 4096));
  field(&O::most_triangles, "most_triangles", "Largest number of triangles of the whole solid; flat parts need few",
        at_least(1));
  field(&O::most_triangles_in_all, "most_triangles_in_all", "Largest number of triangles of all meshes together");
  field(&O::most_meshes, "most_meshes",
        "Largest number of parts of the tree with their own mesh. The whole solid comes first, then primitives, then "
        "inner nodes from the root on.",
        at_least(1));
}
/// Refuses fewer triangles in all than for the solid.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const ReportOptions& options);

/// Summary of signed distances from points to a solid's surface, positive outside, as in metrology.
struct DeviationSummary {
  std::size_t points = 0;
  double mean = 0, standard_deviation = 0;
  double rms = 0;
  double p95 = 0;  ///< 95 % of the distances are smaller in absolute value
  double least = 0, greatest = 0;
};

/// All fields are 0 for no distances. O(n)
[[nodiscard]] DeviationSummary summarise_deviation(std::vector<double> signed_distances);

/// Whether this build contains the report page, which needs Node.js at build time.
[[nodiscard]] bool has_report_page();

/// The report as a self-contained HTML page. Meshes and points are quantised (positions to 1/65535 of the bounds,
/// distances to 11 bits) and compressed. So are texts of the model, and none can be taken for HTML.
/// @throws Error when the model has no tree, the page is not in this build, an option is out of range; Cancelled
[[nodiscard]] std::string report_page(const Report& report, const ReportOptions& options = {},
                                      const RunContext& run = {});

/// Never leaves a partial file. @throws as report_page(), and when the file cannot be written.
void write_report(const std::filesystem::path& file, const Report& report, const ReportOptions& options = {},
                  const RunContext& run = {});

}  // namespace cloud2csg
