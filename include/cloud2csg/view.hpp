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

/// Clouds and solids to look at: pictures, without a window or a browser, and the report, one HTML file that shows a
/// cloud, the solid that was made of it, and how far apart they are.
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

/// Its fields: see the table.
struct PictureOptions {
  int width = 0, height = 600;
  double azimuth_deg = -60, elevation_deg = 25;
  int resolution = 192;
};
void option_table(OptionsOf<PictureOptions>, auto&& field) {
  using O = PictureOptions;
  constexpr OptionRange k_sides = from_to(16, 4096);
  field(&O::width, "width",
        "Width of a .png; 0: a square for the cloud, one for the solid. Pixels, at most 4 million in all.",
        OptionRange{.least = k_sides.least, .most = k_sides.most, .takes_zero = true},
        {.unit = "PIXELS", .option = "picture-width"});
  field(&O::height, "height", "Height of a .png. Pixels.", k_sides, {.unit = "PIXELS", .option = "picture-height"});
  field(&O::azimuth_deg, "azimuth_deg",
        "Where the camera stands, seen from the middle: degrees turned from the x axis towards y", from_to(-360, 360),
        {.unit = "DEG"});
  field(&O::elevation_deg, "elevation_deg", "How far the camera is raised over the xy plane, in degrees",
        from_to(-90, 90), {.unit = "DEG"});
  field(&O::resolution, "resolution",
        "Cells along the longest side of the solid's mesh, of which only outlines show any", from_to(4, 4096),
        k_library);
}
/// More pixels than 4 million.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const PictureOptions& options);

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

/// An option that was in force.
struct ReportParameter {
  std::string group, name, value;
};

/// A file that the page offers to save.
struct ReportDownload {
  std::string name;  ///< without a folder
  std::string content;
};

/// What a report tells of; what is absent has no place on the page.
struct Report {
  std::string title = {};   ///< e.g. the name of the cloud's file
  std::string source = {};  ///< a line on where it comes from
  Model model = {};         ///< with a tree
  std::optional<PointCloud> cloud = {};
  std::optional<ExtractStatistics> statistics = {};
  std::vector<ReportParameter> parameters = {};
  std::vector<ReportDownload> downloads = {};
  std::vector<std::string> warnings = {};  ///< beyond those of the statistics
};

/// How large the page is: see the table.
struct ReportOptions {
  std::size_t most_points = 100'000;
  int resolution = 128, part_resolution = 64;
  std::size_t most_triangles = 24'000, most_triangles_in_all = 120'000;
  std::size_t most_meshes = 240;
};
void option_table(OptionsOf<ReportOptions>, auto&& field) {
  using O = ReportOptions;
  field(&O::most_points, "most_points",
        "Points to show; of more, so many are taken, evenly in space. Figures are of all points. 100 000 take about a "
        "megabyte.",
        at_least(1));
  field(&O::resolution, "resolution", "Cells along the longest side of the whole solid's mesh", from_to(4, 4096));
  field(&O::part_resolution, "part_resolution",
        "Cells along the longest side of the meshes of parts; fewer where there are many parts", from_to(4, 4096));
  field(&O::most_triangles, "most_triangles", "Triangles of the whole solid; flat parts need few", at_least(1));
  field(&O::most_triangles_in_all, "most_triangles_in_all", "Triangles of all meshes together");
  field(
      &O::most_meshes, "most_meshes",
      "Parts of the tree that have a mesh of their own. The whole, then primitives, then inner nodes from the root on.",
      at_least(1));
}
/// Fewer triangles in all than of the solid.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const ReportOptions& options);

/// A distance report as in metrology: signed distances of points to a solid's surface, positive outside.
struct DeviationSummary {
  std::size_t points = 0;
  double mean = 0, standard_deviation = 0;
  double rms = 0;
  double p95 = 0;  ///< 95 % are nearer than this
  double least = 0, greatest = 0;
};

/// Of the distances given; all 0 for none. O(n)
[[nodiscard]] DeviationSummary summarise_deviation(std::vector<double> signed_distances);

/// Whether this build has the page that reports are made of: it takes Node.js to build it.
[[nodiscard]] bool has_report_page();

/// The report as the text of a page that needs nothing else, no network either: meshes and points are quantised
/// (positions to 1/65535 of the bounds, distances to 11 bits) and compressed in it. All texts of the model are part of
/// that, so that none can be taken for HTML.
/// @throws Error when the model has no tree, the page is not in this build, an option is out of range; Cancelled
[[nodiscard]] std::string report_page(const Report& report, const ReportOptions& options = {},
                                      const RunContext& run = {});

/// Nothing half-written. @throws as report_page(), and when the file cannot be written.
void write_report(const std::filesystem::path& file, const Report& report, const ReportOptions& options = {},
                  const RunContext& run = {});

}  // namespace cloud2csg
