#include "cloud2csg/compare.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "field_arguments.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg::app {
namespace {

struct CompareCommand {
  std::string truth;
  std::string result;
  CompareOptions comparing;
  bool is_json = false;
  RunOptions running;

  void run(std::stop_token stop) const;
};

nlohmann::ordered_json or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string to_json_text(const Comparison& comparison) {
  return nlohmann::ordered_json{{"intersection_over_union", or_null(comparison.intersection_over_union)},
                                {"volume_truth", or_null(comparison.volume_truth)},
                                {"volume_result", or_null(comparison.volume_result)},
                                {"mean_distance", comparison.mean_distance},
                                {"hausdorff_distance", comparison.hausdorff_distance},
                                {"size_ratio", or_null(comparison.size_ratio)},
                                {"depth_ratio", or_null(comparison.depth_ratio)}}
      .dump(2);
}

std::string to_table(const Comparison& comparison) {
  std::string table;
  const auto add = [&table](std::string_view name, const std::optional<double>& value) {
    table += fmt::format("{:<26}{}\n", name, value ? fmt::format("{:.6g}", *value) : "-");
  };
  add("intersection over union", comparison.intersection_over_union);
  add("volume of the truth", comparison.volume_truth);
  add("volume of the result", comparison.volume_result);
  add("mean distance", comparison.mean_distance);
  add("Hausdorff distance", comparison.hausdorff_distance);
  add("size ratio", comparison.size_ratio);
  add("depth ratio", comparison.depth_ratio);
  return table;
}

void CompareCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  const Shape3d truth_shape = read_shape(truth);
  const Shape3d result_shape = read_shape(result);
  for (const Shape3d* shape : {&truth_shape, &result_shape}) {
    if (shape->model) session.warn(shape->model->warnings);
  }
  const Comparison comparison = naming(truth + " with " + result, [&] {
    return cloud2csg::compare(truth_shape, result_shape, comparing, session.run());
  });
  session.display().finish();
  if (is_json) {
    fmt::print("{}\n", to_json_text(comparison));
  } else {
    fmt::print("{}", to_table(comparison));
  }
}

void add_options(CLI::App& app, CompareCommand& command, FieldArguments& fields) {
  const std::string kinds = endings_read({FileKind::model, FileKind::mesh, FileKind::cloud});
  add_file(app, "truth", command.truth, "Model, mesh or cloud of the true shape: " + kinds)->type_name("TRUTH");
  add_file(app, "result", command.result, "Model, mesh or cloud to compare with it: " + kinds)->type_name("RESULT");
  app.add_flag("--json", command.is_json, "Print JSON instead of a table; values that cannot be computed are null")
      ->group("Output");
  fields.add(command.comparing, {.group = "Accuracy"});
}

}  // namespace

Command add_compare(CLI::App& program) {
  CLI::App* app = program.add_subcommand("compare", "Measures how alike two shapes are: models, meshes or clouds");
  app->footer(example("  cloud2csg compare true.off extracted.json --json"));
  return make_command<CompareCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
