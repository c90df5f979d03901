#include "cloud2csg/sample.hpp"

#include <fmt/format.h>

#include <optional>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "field_arguments.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

struct SampleCommand {
  std::string shape;
  std::vector<std::string> outputs;
  SampleOptions sampling;
  CloudWriteOptions writing;
  std::optional<double> relative_noise;
  RunOptions running;

  void run(std::stop_token stop) const;
  [[nodiscard]] PointCloud sample(const Shape3d& read, const RunContext& run) const;
};

PointCloud SampleCommand::sample(const Shape3d& read, const RunContext& run) const {
  SampleOptions options = sampling;
  if (relative_noise) options.noise = 0;
  PointCloud cloud;
  if (read.model) {
    cloud = sample_surface(*read.model, options, run);
  } else if (read.mesh) {
    cloud = sample_mesh_surface(*read.mesh, options, run);
  } else {
    throw Error({.expected = "expected a model with a tree or a mesh, found a point cloud",
                 .remedy = "give a model or mesh of the part, from which the cloud was made"});
  }
  if (!relative_noise || *relative_noise == 0) return cloud;
  const double noise = *relative_noise * bounds_of(cloud.positions).diagonal().norm();
  return with_noise(std::move(cloud), noise, sampling.seed);
}

void SampleCommand::run(std::stop_token stop) const {
  check_outputs(outputs, cloud_endings(), {&shape, 1});  // a mesh and a cloud may both be .ply
  Session session(running, std::move(stop));
  const Shape3d read = read_shape(shape);
  if (read.model) session.warn(read.model->warnings);
  const PointCloud cloud = naming(shape, [&] { return sample(read, session.run()); });
  write_clouds(outputs, cloud, writing);
  session.display().note(fmt::format("{} points", cloud.size()));
}

void add_options(CLI::App& app, SampleCommand& command, FieldArguments& fields) {
  add_shape(app, command.shape);
  add_outputs(app, command.outputs, cloud_endings());
  fields.add(command.writing, {.group = "Output"});
  fields.add(command.sampling, {.group = "Sampling"});
  app.add_option("--relative-noise", command.relative_noise,
                 "Noise as a share of the diagonal of the points' bounds, instead of --noise")
      ->transform(number_in<double>(at_least(0)))
      ->type_name("SHARE")
      ->excludes(app.get_option("--noise"))
      ->group("Sampling");
  app.get_option("--density")->excludes(app.get_option("--count"));
}

}  // namespace

Command add_sample(CLI::App& program) {
  CLI::App* app = program.add_subcommand("sample", "Samples a point cloud from the surface of a model or mesh");
  app->footer(example("  cloud2csg sample bracket.json -n 50000 --noise 0.01 -o bracket.ply"));
  return make_command<SampleCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
