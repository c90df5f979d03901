// Share of a cloud's normals with correct orientation from positions alone: shipped models, thin shapes, random models
// from all families, and the models and meshes given as arguments.
//   bench_orientation [--points N] [--noise SHARE] [--given] [--pictures FOLDER] [FILE...]
// --given: only the files. --pictures: coloured .ply, red where the side is wrong.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/families/family.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"

namespace {

namespace c2c = cloud2csg;

const c2c::RunContext k_run{.threads = 2};

struct Named {
  std::string name;
  c2c::PointCloud cloud;  ///< exact, with true normals
};

struct Options {
  std::size_t points = 100'000;
  double noise = 0.0;
  bool given_only = false;
  std::filesystem::path pictures;
  std::vector<std::filesystem::path> files;
};

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--given") {
      options.given_only = true;
    } else if (word == "--points" && i + 1 < argc) {
      options.points = std::stoul(argv[++i]);
    } else if (word == "--noise" && i + 1 < argc) {
      options.noise = std::stod(argv[++i]);
    } else if (word == "--pictures" && i + 1 < argc) {
      options.pictures = argv[++i];
    } else {
      options.files.emplace_back(word);
    }
  }
  return options;
}

c2c::PointCloud of_model(const c2c::Model& model, std::size_t points) {
  return c2c::sample_surface(model, {.count = points}, k_run);
}

c2c::PointCloud of_file(const std::filesystem::path& file, std::size_t points) {
  if (file.extension() != ".json")
    return c2c::sample_mesh(c2c::mend_mesh(c2c::read_mesh(file)).mesh, {.mesh_points = points});
  return of_model(c2c::read_model(file), points);
}

std::vector<Named> clouds_of(const Options& options) {
  std::vector<Named> clouds;
  if (!options.given_only) {
    for (const char* name : {"m0", "m1", "m2", "m3"}) {
      const auto file = std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / (std::string(name) + ".json");
      clouds.push_back({name, of_file(file, options.points)});
    }
    for (const c2c::Family family : c2c::all_families()) {
      for (const std::uint64_t seed : {1U, 2U}) {
        const c2c::Model model = c2c::make_family(family, {.primitives = 20, .seed = seed});
        clouds.push_back({fmt::format("{} {}", c2c::to_string(family), seed), of_model(model, options.points)});
      }
    }
  }
  for (const std::filesystem::path& file : options.files) {
    clouds.push_back({file.stem().string(), of_file(file, options.points)});
  }
  return clouds;
}

void write_picture(const std::filesystem::path& file, const c2c::PointCloud& cloud, const c2c::Points& found) {
  std::ofstream out(file);
  out << fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d place = cloud.positions[i];
    const bool is_right = found[i].dot(cloud.normals[i]) > 0.0;
    out << fmt::format("{} {} {} {}\n", place.x(), place.y(), place.z(), is_right ? "190 200 210" : "220 30 30");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  fmt::print("{} points, noise {} % of the diagonal\n\n", options.points, 100.0 * options.noise);
  fmt::print("| model | oriented rightly | doubtful | bodies | s | s of processor |\n|---|---:|---:|---:|---:|---:|\n");
  for (const Named& named : clouds_of(options)) {
    const double diagonal = c2c::bounds_of(named.cloud.positions).diagonal().norm();
    c2c::PointCloud cloud = c2c::with_noise(named.cloud, options.noise * diagonal);
    const c2c::Points truth = cloud.normals;
    cloud.normals = {};
    const c2c::Scale scale = c2c::estimate_scale(cloud, k_run);
    const std::clock_t cpu = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const c2c::EstimatedNormals found = c2c::estimate_normals(cloud, scale, k_run);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    std::size_t right = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) right += found.normals[i].dot(truth[i]) > 0.0 ? 1 : 0;
    const auto count = static_cast<double>(truth.size());
    fmt::print("| {} | {:.2f} % | {:.2f} % | {} | {:.2f} | {:.2f} |\n", named.name,
               100.0 * static_cast<double>(right) / count, 100.0 * static_cast<double>(found.doubtful.size()) / count,
               found.bodies, seconds, cpu_seconds);
    std::fflush(stdout);
    if (!options.pictures.empty()) {
      cloud.normals = truth;
      write_picture(options.pictures / (named.name + ".ply"), cloud, found.normals);
    }
  }
}
