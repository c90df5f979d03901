#include "cloud2csg/sample.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "command.hpp"
#include "core/base/output_set.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct SampleCommand {
  std::string shape;
  std::vector<std::string> outputs;
  SampleOptions sampling;
  CloudWriteOptions writing;
  std::optional<double> relative_noise;
  bool is_ascii = false;
  RunOptions running;

  void run(std::stop_token stop) const;
  [[nodiscard]] PointCloud sample(const Shape3d& read, const RunContext& run) const;
};

/// Points of a mesh, uniform by area; the noise is left to the caller.
PointCloud sample_of_mesh(const TriangleMesh& mesh, const SampleOptions& sampling, const RunContext& run) {
  if (sampling.density > 0 || sampling.normal_noise_deg > 0) {
    throw Error({.file = {},
                 .where = sampling.density > 0 ? "--density" : "--normal-noise",
                 .expected = "works on models only, this is a mesh",
                 .remedy = "give --count and --noise"});
  }
  return sample_mesh(mesh, {.mesh_points = sampling.count, .seed = sampling.seed}, run);
}

PointCloud SampleCommand::sample(const Shape3d& read, const RunContext& run) const {
  SampleOptions exact = sampling;
  if (read.mesh || relative_noise) exact.noise = 0;
  PointCloud cloud;
  if (read.model) {
    cloud = sample_surface(tree_of(*read.model, shape), read.model->primitives, exact, run);
  } else if (read.mesh) {
    cloud = sample_of_mesh(*read.mesh, exact, run);
  } else {
    throw Error({.file = {},
                 .where = {},
                 .expected = "expected a model with a tree or a mesh, found a point cloud",
                 .remedy = "sample what the cloud was made of"});
  }
  const double noise = relative_noise ? *relative_noise * bounds_of(cloud.positions).diagonal().norm() : sampling.noise;
  return exact.noise == 0 && noise > 0 ? with_noise(std::move(cloud), noise, sampling.seed) : cloud;
}

void SampleCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, cloud_endings());
  std::vector<std::string> files = outputs;
  files.push_back(shape);  // a mesh and a cloud may both be .ply
  check_distinct(files);
  Session session(running, std::move(stop));
  const Shape3d read = read_shape(shape);
  if (read.model) session.warn(read.model->warnings);
  const PointCloud cloud = naming(shape, [&] { return sample(read, session.run()); });
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
  add_file(app, "shape", command.shape,
           fmt::format("Model file with a tree: {}, or mesh: {}", endings_read({FileKind::model}),
                       endings_read({FileKind::mesh})))
      ->type_name("MODEL|MESH");
  add_outputs(app, command.outputs, cloud_endings());
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
  CLI::Option* noise = app.add_option("--noise", sampling.noise, "Standard deviation by which each coordinate is moved")
                           ->check(number_not_negative())
                           ->type_name("SIGMA")
                           ->group("Sampling")
                           ->capture_default_str();
  app.add_option("--relative-noise", command.relative_noise, "The same as a share of the diagonal, instead of --noise")
      ->check(number_not_negative())
      ->type_name("SHARE")
      ->excludes(noise)
      ->group("Sampling");
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
  CLI::App* app = program.add_subcommand("sample", "Makes a point cloud on the surface of a model or mesh");
  app->footer(example("  cloud2csg sample bracket.json -n 50000 --noise 0.01 -o bracket.ply"));
  auto command = std::make_shared<SampleCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
