#include "cloud2csg/extract.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "core/base/files.hpp"
#include "core/base/run.hpp"
#include "core/base/warnings.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "raw_options.hpp"
#include "verdict.hpp"

namespace cloud2csg::app {
namespace {

std::string merge_ways(const MergeStatistics& merge) {
  std::vector<std::string_view> ways;
  for (const MergeWay way : merge.ways) ways.push_back(to_string(way));
  return fmt::format("{}", fmt::join(ways, ", "));
}

std::string primitives_line(const ExtractStatistics& s) {
  if (s.clique_histogram.empty()) return fmt::format("primitives   {}", s.primitives);
  return fmt::format("primitives   {}; cliques by size ({})", s.primitives, fmt::join(s.clique_histogram, ", "));
}

std::string partitions_line(const ExtractStatistics& s) {
  return fmt::format("partitions   {} in {} component{}; merge: {}", s.partitions.size(), s.components,
                     s.components == 1 ? "" : "s", merge_ways(s.merge));
}

std::string cells_line(const CellStatistics& cells) {
  return fmt::format("cells        {}, {} of them open; {:.2g} % of the points' evidence is contradicted", cells.cells,
                     cells.open_cells, 100 * cells.contradicted_share());
}

std::string way_line(const ExtractStatistics& s) {
  if (s.cells) return cells_line(*s.cells);
  if (s.finding && s.strategy == Strategy::automatic) return "tree from    the choice of solids";
  return partitions_line(s);
}

std::string refine_line(const RefineStatistics& s) {
  if (!s.is_taken) return "refined      nothing: the primitives fit the points best as they were";
  double shift = 0;
  double turn = 0;
  for (const PrimitiveChange& change : s.changes) {
    shift = std::max(shift, change.largest_shift);
    turn = std::max(turn, change.turn_deg);
  }
  return fmt::format("refined      rms distance {:.3g} -> {:.3g}; changes up to {:.2g} and {:.2g} deg; {} regularities",
                     s.rms_before, s.rms_after, shift, turn, s.regularities.size());
}

std::vector<std::string> finding_lines(const FindingStatistics& s, const StageSeconds& seconds) {
  const auto count = [&s](SurfaceType type) { return std::ranges::count(s.surfaces, type); };
  const LargestChange largest = largest_change(s.snaps);
  std::vector<std::string> lines{
      fmt::format("scale        diagonal {:.4g}, spacing {:.3g}, noise {:.3g}: tolerance {:.3g}{}", s.diagonal,
                  s.spacing, s.noise, s.tolerance, s.normals_estimated ? "; normals estimated" : ""),
      fmt::format("surfaces     {} planes, {} spheres, {} cylinders, {} cones, {} tori; {} points on no surface",
                  count(SurfaceType::plane), count(SurfaceType::sphere), count(SurfaceType::cylinder),
                  count(SurfaceType::cone), count(SurfaceType::torus), s.unexplained_points),
      fmt::format("regular      {} values made regular, by at most {:.2g} and {:.2g} deg", s.snaps.size(),
                  largest.shift, largest.turn_deg),
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

/// A summary in a few lines: points, primitives, partitions, tree, fit, time by stage, files.
std::vector<std::string> summary_of(const ExtractStatistics& s, std::span<const std::string> files) {
  std::vector<std::string> lines;
  if (s.finding) lines = finding_lines(*s.finding, s.seconds);
  std::vector<std::string> extraction{
      fmt::format("points       {}, {} of them on no primitive; noise {:.3g}", s.points, s.unassigned_points, s.noise),
      primitives_line(s),
      way_line(s),
      fmt::format("tree         {} nodes, {} leaves, {} levels; price {:.3g}, {} operations{}", s.tree.size,
                  s.tree.leaves, s.tree.levels, s.tree.price, s.tree.operations,
                  s.cells && s.cells->is_minimal ? "; no smaller tree has these cells" : ""),
      fmt::format("fit          rms distance {:.3g}, 95 % below {:.3g}, rms angle {:.3g} deg", s.fit.rms_distance,
                  s.fit.p95_distance, s.fit.rms_angle_deg),
      fmt::format("extraction   {:.1f} ms: {}", s.seconds.extraction * 1e3, stage_times(s.seconds)),
      fmt::format("total        {:.1f} ms: read {:.1f}, write {:.1f}", s.seconds.total * 1e3, s.seconds.read * 1e3,
                  s.seconds.write * 1e3)};
  if (s.refine) extraction.insert(extraction.begin() + 2, refine_line(*s.refine));
  lines.insert(lines.end(), extraction.begin(), extraction.end());
  for (std::size_t k = 0; k < files.size(); ++k) {
    lines.push_back(fmt::format("{}{}", k == 0 ? "wrote        " : "             ", files[k]));
  }
  return lines;
}

struct ExtractCommand {
  std::string cloud;
  std::string primitives;  // empty: to be found in the cloud
  bool detect_rest = false;
  std::vector<std::string> outputs;
  std::optional<std::string> statistics;
  std::optional<std::string> unexplained;
  bool json = false;
  bool refine = false;
  std::string preset = "default";
  ReconstructOptions options;
  InputOptions reading;
  ExportOptions exporting;
  PictureOptions drawing;
  RunOptions running;
  std::vector<ReportParameter> parameters;

  void prepare();
  void settle(const CLI::App& app);
  [[nodiscard]] int run(const std::stop_token& stop) const;
  void fail(std::string_view message) const {
    if (json) tell_failure(message);
  }
  /// `given` is empty when all primitives are to be found.
  [[nodiscard]] Extraction extract(Input input, const PrimitiveSet& given, const RunContext& run) const;
  [[nodiscard]] Extraction extract_over(PointCloud points, const PrimitiveSet& solids, const RunContext& run) const;
  /// The outputs, after checking that they can be written.
  [[nodiscard]] std::vector<std::string> check_files() const;
  [[nodiscard]] PointCloud unexplained_part(const Extraction& result, int threads) const;
  [[nodiscard]] AddedModels write(const Extraction& result, const RunContext& run, OutputSet& written) const;
  void draw(const Extraction& result, const RunContext& run, OutputSet& written) const;
  void report(Extraction result, std::vector<ReportDownload> downloads, const RunContext& run,
              OutputSet& written) const;
  /// Writes all files, or none, and completes the statistics.
  [[nodiscard]] ExtractStatistics write_all(Extraction result, const Stopwatch& total, const RunContext& run) const;
};

void ExtractCommand::prepare() {
  if (preset == "paper") options.extraction = paper_options();
}

void ExtractCommand::settle(const CLI::App& app) {
  share_values(options, reading);
  parameters = parameters_of(app);
}

void check_normals(const PointCloud& cloud, const std::string& file) {
  if (cloud.has_normals()) return;
  throw Error({.file = file,
               .expected = "the points have no normals, which extract needs to combine given primitives",
               .remedy = "save outward normals with the points, add --detect-rest, or leave out --primitives"});
}

PointCloud ExtractCommand::unexplained_part(const Extraction& result, int threads) const {
  const std::vector<std::uint32_t> indices =
      unexplained_points(result.model, result.cloud, result.statistics.fit.tolerances, {.threads = threads});
  return select_points(result.cloud, indices);
}

std::string headline(const ExtractStatistics& statistics, const std::string& cloud) {
  return fmt::format(
      "{}extracted by cloud2csg {} from {} (seed {})\n{} nodes, {} leaves, {} levels; rms distance {:.4g}, rms angle "
      "{:.3g} deg\n{}",
      statistics.complete ? "" : "INCOMPLETE: the search was stopped before its end\n", CLOUD2CSG_VERSION, cloud,
      statistics.seed, statistics.tree.size, statistics.tree.leaves, statistics.tree.levels,
      statistics.fit.rms_distance, statistics.fit.rms_angle_deg, to_text(statistics.verdict));
}

AddedModels ExtractCommand::write(const Extraction& result, const RunContext& run, OutputSet& written) const {
  const std::string comment = headline(result.statistics, cloud);
  Model model = result.model;
  model.description = comment;
  ExportOptions commented = exporting;
  commented.openscad.comment = commented.script.comment = comment;
  // No stop here: an interrupt still writes the result so far.
  return naming(primitives.empty() ? cloud : primitives,
                [&] { return add_models(written, outputs, model, commented, without_stop(run)); });
}

void ExtractCommand::draw(const Extraction& result, const RunContext& run, OutputSet& written) const {
  if (std::none_of(outputs.begin(), outputs.end(), is_picture)) return;
  const Scene scene{.model = result.model, .cloud = result.cloud};
  naming(cloud, [&] { add_pictures(written, outputs, scene, drawing, without_stop(run)); });
}

void ExtractCommand::report(Extraction result, std::vector<ReportDownload> downloads, const RunContext& run,
                            OutputSet& written) const {
  if (std::none_of(outputs.begin(), outputs.end(), is_report)) return;
  const ExtractStatistics& outcome = result.statistics;
  Report report{.title = std::filesystem::path(cloud).filename().string(),
                .source = headline(outcome, cloud),
                .model = std::move(result.model),
                .cloud = std::move(result.cloud),
                .statistics = outcome,
                .parameters = parameters,
                .downloads = std::move(downloads)};
  naming(cloud, [&] { add_reports(written, outputs, report, without_stop(run)); });
}

Extraction ExtractCommand::extract_over(PointCloud points, const PrimitiveSet& solids, const RunContext& run) const {
  Extraction result =
      refine ? extract_refined_csg(points, solids, options.extraction, refine_options_for(options.extraction), run)
             : extract_csg(points, solids, options.extraction, run);
  result.cloud = std::move(points);
  return result;
}

Extraction ExtractCommand::extract(Input input, const PrimitiveSet& given, const RunContext& run) const {
  const std::string files = primitives.empty() ? cloud : cloud + " with " + primitives;
  if (!primitives.empty() && !detect_rest) {
    check_normals(input.cloud, cloud);
    return naming(files, [&] { return extract_over(std::move(input.cloud), given, run); });
  }
  ReconstructOptions from_raw = options_for(input, options);
  from_raw.known = given;
  if (refine) from_raw.refine = refine_options_for(options.extraction);
  return naming(files, [&] { return reconstruct(input.cloud, from_raw, run); });
}

std::vector<std::string> ExtractCommand::check_files() const {
  for (const std::string& file : outputs) check_output(file, model_endings());
  if (statistics) check_output(*statistics, ".json", true);
  if (unexplained) check_output(*unexplained, cloud_endings());
  std::vector<std::string> written = outputs;
  if (unexplained) written.push_back(*unexplained);
  if (statistics) written.push_back(*statistics);
  std::vector<std::string> all = written;
  std::ranges::copy(inputs_of(cloud, primitives), std::back_inserter(all));
  check_distinct(all);
  return written;
}

ExtractStatistics ExtractCommand::write_all(Extraction result, const Stopwatch& total, const RunContext& run) const {
  const Stopwatch writing;
  OutputSet written;
  AddedModels models = write(result, run, written);
  if (unexplained) {
    written.add(*unexplained, [&](const std::filesystem::path& path) {
      write_point_cloud(path, unexplained_part(result, run.threads));
    });
  }
  ExtractStatistics& outcome = result.statistics;
  outcome.seconds.write = writing.seconds();
  outcome.seconds.total = total.seconds();
  outcome.warnings.insert(outcome.warnings.end(), models.warnings.begin(), models.warnings.end());
  if (statistics) {
    written.add(*statistics, [&](const std::filesystem::path& path) { write_text_file(path, to_json(outcome)); });
  }
  ExtractStatistics told = outcome;
  draw(result, run, written);
  report(std::move(result), std::move(models.texts), run, written);
  written.commit();
  return told;
}

int ExtractCommand::run(const std::stop_token& stop) const {
  const Stopwatch total;
  const std::vector<std::string> to_write = check_files();
  Session session(running, stop);

  Model given;
  if (!primitives.empty()) given = read_model(primitives);
  Input input = read_cloud_or_mesh(cloud, reading, session.run());
  std::vector<std::string> doubts = std::move(given.warnings);
  doubts.insert(doubts.end(), input.warnings.begin(), input.warnings.end());
  const double read_seconds = total.seconds();
  Extraction result = with_warnings(doubts, [&] { return extract(std::move(input), given.primitives, session.run()); });
  ExtractStatistics& outcome = result.statistics;
  outcome.warnings.insert(outcome.warnings.begin(), doubts.begin(), doubts.end());
  outcome.seconds.read = read_seconds;
  if (outcome.verdict.grade == Grade::failed) {
    session.warn(outcome.warnings);
    return tell_verdict(session, outcome, {}, json);
  }
  const ExtractStatistics told = write_all(std::move(result), total, session.run());
  session.warn(told.warnings);
  for (const std::string& line : summary_of(told, to_write)) session.display().note(line);
  const bool is_interrupted = stop.stop_requested() && !told.complete;
  if (is_interrupted) session.display().say("cloud2csg: interrupted: the best tree so far was written");
  const int status = tell_verdict(session, told, to_write, json);
  return is_interrupted ? k_failed : status;
}

void add_options(CLI::App& app, ExtractCommand& command, FieldArguments& fields) {
  add_cloud(app, command.cloud);
  CLI::Option* primitives = add_primitives(
      app, command.primitives, " with the primitives to combine; without it, primitives are found in the cloud");
  CLI::Option* detect_rest =
      app.add_flag(
             "--detect-rest", command.detect_rest,
             "Keep the given primitives unchanged, and find further primitives in the points that they do not explain")
          ->needs(primitives)
          ->group("Input");
  add_outputs(app, command.outputs, model_endings());
  fields.add(command.exporting, {.group = "Output"});
  add_json_option(app, command.json);
  app.add_option("--stats", command.statistics, "File for statistics: times, search, merge, fit")
      ->check(file_name())
      ->type_name("STATS.json")
      ->group("Output");
  app.add_option("--unexplained", command.unexplained,
                 "File for the points that the tree contradicts, off its surface or with a different normal: " +
                     cloud_endings())
      ->check(file_name())
      ->type_name("CLOUD")
      ->group("Output");
  app.add_flag("--refine", command.refine,
               "Fit positions, directions and sizes of the primitives to the points, make nearly regular ones regular, "
               "and extract again")
      ->excludes(detect_rest)
      ->group("Fit");
  add_raw_options(fields, command.options, command.reading);
  app.add_option("--preset", command.preset, "default, or paper: the paper's weights and search, without additions")
      ->check(one_of({"default", "paper"}))
      ->type_name("NAME")
      ->group("Search")
      ->capture_default_str();
  fields.add(command.options.extraction, {.group = "Search", .path = "extraction.", .paper = paper_options()});
  fields.add(command.drawing, {.group = "Pictures"});
}

}  // namespace

Command add_extract(CLI::App& program) {
  CLI::App* app = program.add_subcommand("extract", "Turns a point cloud, a scan or a mesh into a CSG tree");
  app->footer(
      "A .json output keeps all primitives: with --refine the refined ones, otherwise as given or found. The tree "
      "leaves out primitives that no point supports.\n\n" +
      example("  cloud2csg extract scan.ply -o bracket.scad\n"
              "  cloud2csg extract bracket.ply --primitives fitted.json -o bracket.scad -o bracket.json\n"
              "  cloud2csg extract scan.ply --primitives known.json --detect-rest --radii 2.5,3 -o bracket.scad"));
  return make_command<ExtractCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
