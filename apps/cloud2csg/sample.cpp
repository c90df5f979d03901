#include "cloud2csg/sample.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/output_set.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "command.hpp"
#include "outputs.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct SampleCommand {
  std::string model;
  std::vector<std::string> outputs;
  SampleOptions sampling;
  CloudWriteOptions writing;
  bool is_ascii = false;
  RunOptions running;

  void run(std::stop_token stop) const;
};

void SampleCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, cloud_endings());
  check_distinct(outputs);
  Session session(running, std::move(stop));
  const Model read = read_model(model);
  const CsgTree& tree = tree_of(read, model);
  const PointCloud cloud =
      naming(model, [&] { return sample_surface(tree, read.primitives, sampling, session.run()); });
  OutputSet written;
  for (const std::string& file : outputs) {
    written.add(file, [&](const std::filesystem::path& path) {
      write_point_cloud(path, cloud, {.binary = !is_ascii, .double_precision = writing.double_precision});
    });
  }
  written.commit();
  session.display().note(fmt::format("{} points", cloud.size()));
}

void add_options(CLI::App& app, SampleCommand& command) {
  add_file(app, "model", command.model, "Model file with a tree")->type_name("MODEL.json");
  add_outputs(app, command.outputs, join_endings(cloud_endings()));
  app.add_flag("--ascii", command.is_ascii, "Text instead of binary numbers in .ply and .pcd")->group("Output");
  SampleOptions& sampling = command.sampling;
  CLI::Option* count = app.add_option("-n,--count", sampling.count, "How many points")
                           ->transform(whole_number_from(1))
                           ->type_name("COUNT")
                           ->group("Sampling")
                           ->capture_default_str();
  app.add_option("--density", sampling.density, "Points per unit of area, instead of --count")
      ->check(number_not_negative())
      ->type_name("D")
      ->excludes(count)
      ->group("Sampling");
  app.add_option("--noise", sampling.noise, "Standard deviation by which each coordinate is moved")
      ->check(number_not_negative())
      ->type_name("SIGMA")
      ->group("Sampling")
      ->capture_default_str();
  app.add_option("--normal-noise", sampling.normal_noise_deg,
                 "Standard deviation by which normals are tilted, in degrees")
      ->check(number_not_negative())
      ->type_name("DEG")
      ->group("Sampling")
      ->capture_default_str();
  app.add_option("--seed", sampling.seed, "Same seed, same points")
      ->transform(whole_number_from(0))
      ->type_name("S")
      ->group("Sampling")
      ->capture_default_str();
  add_run_options(app, command.running);
}

}  // namespace

Command add_sample(CLI::App& program) {
  CLI::App* app = program.add_subcommand("sample", "Makes a point cloud on the surface of a model");
  app->footer(example("  cloud2csg sample bracket.json -n 50000 --noise 0.01 -o bracket.ply"));
  auto command = std::make_shared<SampleCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
