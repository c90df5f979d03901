#include "reports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "cloud2csg/error.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

/// Empty when it has none.
std::string value_of(const CLI::Option& option) {
  if (option.count() == 0) return option.get_default_str();
  if (option.get_expected_max() == 0) return "yes";
  return fmt::format("{}", fmt::join(option.results(), ", "));
}

std::string merge_ways(const MergeStatistics& merge) {
  std::vector<std::string_view> ways;
  for (const MergeWay way : merge.ways) ways.push_back(to_string(way));
  return fmt::format("{}", fmt::join(ways, ", "));
}

std::string partitions_line(const ExtractStatistics& s) {
  return fmt::format("partitions   {} in {} component{}; merge: {}", s.partitions.size(), s.components,
                     s.components == 1 ? "" : "s", merge_ways(s.merge));
}

std::string cells_line(const CellStatistics& cells) {
  return fmt::format("cells        {}, {} of them open; {:.2g} % of what the points say is contradicted", cells.cells,
                     cells.open_cells, 100 * cells.contradicted_share());
}

/// How the tree was found.
std::string way_line(const ExtractStatistics& s) {
  if (s.cells) return cells_line(*s.cells);
  if (s.finding && s.finding->is_tree_of_choice) return "way          the tree that the solids were chosen with";
  return partitions_line(s);
}

std::string refine_line(const RefineStatistics& s) {
  if (!s.is_taken) return "refined      nothing: the primitives are where the points are";
  double shift = 0;
  double turn = 0;
  for (const PrimitiveChange& change : s.changes) {
    shift = std::max(shift, change.largest_shift);
    turn = std::max(turn, change.turn_deg);
  }
  return fmt::format("refined      rms distance {:.3g} -> {:.3g}; up to {:.2g} and {:.2g} deg; {} regularities",
                     s.rms_before, s.rms_after, shift, turn, s.regularities.size());
}

/// How the primitives were found.
std::vector<std::string> finding_lines(const FindingStatistics& s, const StageSeconds& seconds) {
  const auto count = [&s](SurfaceType type) { return std::ranges::count(s.surfaces, type); };
  const LargestChange largest = largest_change(s.snaps);
  std::vector<std::string> lines{
      fmt::format("scale        diagonal {:.4g}, spacing {:.3g}, noise {:.3g}: tolerance {:.3g}{}", s.diagonal,
                  s.spacing, s.noise, s.tolerance, s.normals_estimated ? "; normals estimated" : ""),
      fmt::format("surfaces     {} planes, {} spheres, {} cylinders, {} cones, {} tori; {} points on none",
                  count(SurfaceType::plane), count(SurfaceType::sphere), count(SurfaceType::cylinder),
                  count(SurfaceType::cone), count(SurfaceType::torus), s.unexplained_points),
      fmt::format("regular      {} values snapped, by at most {:.2g} and {:.2g} deg", s.snaps.size(), largest.shift,
                  largest.turn_deg),
      fmt::format("found in     {:.2f} s: clean {:.2f}, normals {:.2f}, detect {:.2f}, solids {:.2f}",
                  seconds.clean + seconds.normals + seconds.detect + seconds.solids, seconds.clean, seconds.normals,
                  seconds.detect, seconds.solids)};
  if (s.known > 0) {
    lines.insert(lines.begin() + 1, fmt::format("known        {} primitive{}, {} points on them", s.known,
                                                s.known == 1 ? "" : "s", s.known_points));
  }
  return lines;
}

/// The stages that took at least a thousandth of the extraction, in milliseconds.
std::string stage_times(const StageSeconds& seconds) {
  std::string text;
  using Stage = std::pair<const char*, double>;
  const std::array stages{Stage{"segment", seconds.segment},     Stage{"overlap", seconds.overlap},
                          Stage{"partition", seconds.partition}, Stage{"classes", seconds.classes},
                          Stage{"search", seconds.search},       Stage{"merge", seconds.merge},
                          Stage{"simplify", seconds.simplify},   Stage{"refine", seconds.refine}};
  for (const auto& [name, value] : stages) {
    if (value < 1e-3 * seconds.extraction) continue;
    text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ", name, value * 1e3);
  }
  return text;
}

}  // namespace

void check_report_page(const std::string& file) {
  if (has_report_page()) return;
  throw Error({.file = file,
               .expected = "cannot be shown: this cloud2csg was built without the page of reports",
               .remedy = "install Node.js 18 or later with npm, and build again with -DCLOUD2CSG_VIEWER=ON"});
}

std::vector<ReportParameter> parameters_of(const CLI::App& command) {
  std::vector<ReportParameter> parameters;
  for (const CLI::Option* option : command.get_options()) {
    if (option == command.get_help_ptr()) continue;
    const std::string value = value_of(*option);
    if (!value.empty()) parameters.push_back({option->get_group(), option->get_name(), value});
  }
  return parameters;
}

void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run) {
  for (const std::string& file : files) {
    if (!is_report(file)) continue;
    set.add(file, [&](const std::filesystem::path& path) { write_report(path, report, {}, run); });
  }
}

std::vector<std::string> summary_of(const ExtractStatistics& s, std::span<const std::string> files) {
  std::vector<std::string> lines;
  if (s.finding) lines = finding_lines(*s.finding, s.seconds);
  std::vector<std::string> extraction{
      fmt::format("points       {}, {} of them on no primitive; noise {:.3g}", s.points, s.unassigned_points, s.noise),
      fmt::format("primitives   {}; cliques by size ({})", s.primitives, fmt::join(s.clique_histogram, ", ")),
      way_line(s),
      fmt::format("tree         {} nodes, {} leaves, {} levels{}", s.tree.size, s.tree.leaves, s.tree.levels,
                  s.cells && s.cells->is_minimal ? "; none smaller has these cells" : ""),
      fmt::format("fit          rms distance {:.3g}, 95 % below {:.3g}, rms angle {:.3g} deg", s.fit.rms_distance,
                  s.fit.p95_distance, s.fit.rms_angle_deg),
      fmt::format("extraction   {:.1f} ms: {}", s.seconds.extraction * 1e3, stage_times(s.seconds)),
      fmt::format("in all       {:.1f} ms: read {:.1f}, write {:.1f}", s.seconds.total * 1e3, s.seconds.read * 1e3,
                  s.seconds.write * 1e3)};
  if (s.refine) extraction.insert(extraction.begin() + 2, refine_line(*s.refine));
  lines.insert(lines.end(), extraction.begin(), extraction.end());
  for (std::size_t k = 0; k < files.size(); ++k) {
    lines.push_back(fmt::format("{}{}", k == 0 ? "wrote        " : "             ", files[k]));
  }
  return lines;
}

}  // namespace cloud2csg::app
