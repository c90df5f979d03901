#include "command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "config_file.hpp"
#include "core/base/file_ending.hpp"
#include "usage.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

bool has_ending_of(const std::string& file, std::initializer_list<const char*> endings) {
  return std::ranges::find(endings, lower_ending(file)) != endings.end();
}

}  // namespace

void add_run_options(CLI::App& options, RunOptions& values) {
  options.add_option("--threads", values.threads, "Threads to use; 0 = all cores")
      ->transform(whole_number(0, 1024))
      ->type_name("N")
      ->group("Running")
      ->capture_default_str();
  options.add_flag("-q,--quiet", values.quiet, "No progress and no notes on standard error")->group("Running");
  add_config_options(options);
}

Session::Session(const RunOptions& options, std::stop_token stop)
    : display_(stderr, progress_style(stderr, options.quiet)),
      run_{.stop = std::move(stop),
           .on_progress = [this](const Progress& progress) { display_.update(progress); },
           .threads = options.threads} {}

CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings) {
  return options
      .add_option("-o,--output", files, fmt::format("File to write, by its ending: {}; may be repeated", endings))
      ->check(file_name())
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
}

CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help) {
  return options.add_option(name, file, help)->check(file_name())->required();
}

void check_cloud_and_primitives(const std::string& cloud, const std::string& primitives) {
  if (cloud == primitives) {
    throw WrongUsage({.file = cloud,
                      .where = {},
                      .expected = "is named as the cloud and by --primitives",
                      .remedy = "give the points first, and by --primitives a model with the primitives in them"});
  }
  if (!primitives.empty()) check_model_input(primitives);
  if (!has_ending_of(cloud, {".json", ".scad", ".csg"})) return;
  throw Error({.file = cloud,
               .where = {},
               .expected = "expected a point cloud or a mesh, found a model",
               .remedy = "'convert' writes it in other formats, 'info' tells what it holds, 'sample' makes a cloud"});
}

void check_model_input(const std::string& file) {
  if (!has_ending_of(file, {".ply", ".pcd", ".xyz", ".xyzn", ".txt", ".pts", ".stl", ".off", ".obj", ".3mf", ".glb"}))
    return;
  throw Error({.file = file,
               .where = {},
               .expected = "expected a model (.json, .scad, .csg), found a mesh or a cloud",
               .remedy = "'extract' makes a model of it"});
}

const CsgTree& tree_of(const Model& model, const std::string& file) {
  if (model.tree) return *model.tree;
  throw Error({.file = file,
               .where = "/tree",
               .expected = "the model has primitives but no tree",
               .remedy = "extract a tree from a cloud first, or add a \"tree\" that combines the primitives"});
}

std::string example(const std::string& lines) {
  return "Example:\n" + lines;
}

}  // namespace cloud2csg::app
