#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "core/base/files.hpp"
#include "core/base/run.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "raw_options.hpp"
#include "reports.hpp"
#include "summary.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct ExtractCommand {
  std::string cloud;
  std::string primitives;  // empty: to be found in the cloud
  bool detect_rest = false;
  std::vector<std::string> outputs;
  std::optional<std::string> statistics;
  std::optional<std::string> unexplained;
  bool refine = false;
  std::string preset = "default";
  ReconstructOptions options;
  InputOptions reading;
  ExportOptions exporting;
  PictureOptions drawing;
  RunOptions running;
  std::vector<ReportParameter> parameters;  // options, for reports

  void prepare();
  void settle(const CLI::App& app);
  void run(const std::stop_token& stop) const;
  /// `given` is empty when all primitives are to be found.
  [[nodiscard]] Extraction extract(Input input, const PrimitiveSet& given, const RunContext& run) const;
  [[nodiscard]] Extraction extract_over(PointCloud points, const PrimitiveSet& solids, const RunContext& run) const;
  [[nodiscard]] RefineOptions refine_options() const;
  /// What is going to be written, after a look at whether it can be.
  [[nodiscard]] std::vector<std::string> check_files() const;
  [[nodiscard]] PointCloud unexplained_part(const Extraction& result, int threads) const;
  [[nodiscard]] AddedModels write(const Extraction& result, const RunContext& run, OutputSet& written) const;
  void draw(const Extraction& result, const RunContext& run, OutputSet& written) const;
  void report(Extraction result, std::vector<ReportDownload> downloads, const RunContext& run,
              OutputSet& written) const;
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
  throw Error(
      {.file = file,
       .expected = "the points have no normals, which extract needs to combine given primitives",
       .remedy = "estimate outward normals and save them with the points, add --detect-rest, or leave out --primitives "
                 "to find them anew"});
}

/// The points that the tree contradicts.
PointCloud ExtractCommand::unexplained_part(const Extraction& result, int threads) const {
  const SegmentationTolerances tolerances =
      segmentation_tolerances(options.extraction.segmentation, result.statistics.noise);
  const std::vector<std::uint32_t> indices =
      unexplained_points(result.tree(), result.model.primitives, result.cloud, tolerances, {.threads = threads});
  return select_points(result.cloud, indices);
}

std::string headline(const ExtractStatistics& statistics, const std::string& cloud) {
  return fmt::format(
      "{}extracted by cloud2csg {} from {} (seed {})\n{} nodes, {} leaves, {} levels; rms distance {:.4g}, rms angle "
      "{:.3g} deg",
      statistics.complete ? "" : "INCOMPLETE: the search was stopped before its end\n", CLOUD2CSG_VERSION, cloud,
      statistics.seed, statistics.tree.size, statistics.tree.leaves, statistics.tree.levels,
      statistics.fit.rms_distance, statistics.fit.rms_angle_deg);
}

AddedModels ExtractCommand::write(const Extraction& result, const RunContext& run, OutputSet& written) const {
  const std::string comment = headline(result.statistics, cloud);
  Model model = result.model;
  model.description = comment;
  ExportOptions commented = exporting;
  commented.openscad.comment = commented.script.comment = comment;
  // Not to be stopped: what has been found is written also after an interrupt.
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

RefineOptions ExtractCommand::refine_options() const {
  return {.angle_tolerance_deg = options.extraction.segmentation.angle_tolerance_deg};
}

Extraction ExtractCommand::extract_over(PointCloud points, const PrimitiveSet& solids, const RunContext& run) const {
  Extraction result = refine ? extract_refined_csg(points, solids, options.extraction, refine_options(), run)
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
  if (refine) from_raw.refine = refine_options();
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
  all.push_back(cloud);
  if (!primitives.empty() && primitives != cloud) all.push_back(primitives);
  check_distinct(all);
  return written;
}

void ExtractCommand::run(const std::stop_token& stop) const {
  const Stopwatch total;
  const std::vector<std::string> to_write = check_files();
  Session session(running, stop);

  Model given;
  if (!primitives.empty()) given = read_model(primitives);
  Input input = read_cloud_or_mesh(cloud, reading, session.run());
  std::vector<std::string> doubts = std::move(given.warnings);
  doubts.insert(doubts.end(), input.warnings.begin(), input.warnings.end());
  const double read_seconds = total.seconds();
  Extraction result = extract(std::move(input), given.primitives, session.run());
  result.statistics.warnings.insert(result.statistics.warnings.begin(), doubts.begin(), doubts.end());

  const Stopwatch writing;
  OutputSet written;
  AddedModels models = write(result, session.run(), written);
  if (unexplained) {
    written.add(*unexplained, [&](const std::filesystem::path& path) {
      write_point_cloud(path, unexplained_part(result, session.run().threads));
    });
  }
  StageSeconds& seconds = result.statistics.seconds;
  seconds.read = read_seconds;
  seconds.write = writing.seconds();
  seconds.total = total.seconds();
  result.statistics.warnings.insert(result.statistics.warnings.end(), models.warnings.begin(), models.warnings.end());
  if (statistics) {
    written.add(*statistics,
                [&](const std::filesystem::path& path) { write_text_file(path, to_json(result.statistics)); });
  }
  const ExtractStatistics summary = result.statistics;
  draw(result, session.run(), written);
  report(std::move(result), std::move(models.texts), session.run(), written);
  written.commit();

  session.warn(summary.warnings);
  for (const std::string& line : summary_of(summary, to_write)) session.display().note(line);
  if (stop.stop_requested() && !summary.complete) {
    throw Error({.where = "interrupted", .expected = "the best tree so far was written"});
  }
}

void add_options(CLI::App& app, ExtractCommand& command, FieldArguments& fields) {
  add_file(app, "cloud", command.cloud,
           fmt::format("Point cloud: {}, or mesh: {}", endings_read({FileKind::cloud}), endings_read({FileKind::mesh})))
      ->type_name("CLOUD|MESH");
  CLI::Option* primitives =
      app.add_option("--primitives", command.primitives,
                     "Model " + endings_read({FileKind::model}) +
                         " with the primitives to combine; if not given, they are found in the cloud")
          ->check(file_name())
          ->type_name("MODEL")
          ->group("Input");
  CLI::Option* detect_rest =
      app.add_flag("--detect-rest", command.detect_rest,
                   "Keep the primitives that are given as they are, and find in the cloud what they leave unexplained")
          ->needs(primitives)
          ->group("Input");
  add_outputs(app, command.outputs, model_endings());
  fields.add(command.exporting, {.group = "Output"});
  app.add_option("--stats", command.statistics, "Statistics: times, search, merge, fit")
      ->check(file_name())
      ->type_name("STATS.json")
      ->group("Output");
  app.add_option("--unexplained", command.unexplained,
                 "The points that the tree contradicts: off its surface, or with another normal")
      ->check(file_name())
      ->type_name("CLOUD")
      ->group("Output");
  app.add_flag("--refine", command.refine,
               "Move, turn and size the primitives to where the points are, make regular what nearly is, and extract "
               "again")
      ->excludes(detect_rest)
      ->group("Fit");
  add_raw_options(fields, command.options, command.reading);
  app.add_option("--preset", command.preset, "default, or paper: the paper's weights and search, nothing added")
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
      "A .json output keeps all primitives, with --refine as they are then, else as they were given or found; the tree "
      "leaves out those that no point supports.\n\n" +
      example("  cloud2csg extract scan.ply -o bracket.scad\n"
              "  cloud2csg extract bracket.ply --primitives fitted.json -o bracket.scad -o bracket.json\n"
              "  cloud2csg extract scan.ply --primitives known.json --detect-rest --radii 2.5,3 -o bracket.scad"));
  return make_command<ExtractCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
