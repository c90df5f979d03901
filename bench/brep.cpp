#include "cloud2csg/advanced/brep.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/families/family.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/run.hpp"

/// STEP files of given models (default: the shipped ones and one per family): time, validity, volume error.
namespace cloud2csg {
namespace {

void print_row(const std::string& name, const Model& model) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "cloud2csg_bench.step";
  const Stopwatch watch;
  const BrepReport report = write_step(file, model, {}, {.threads = 0});
  const double seconds = watch.seconds();
  fmt::print("| {} | {} | {:.2f} | {} | {} | {} | {:.6g} | {:.6g} | {:.4f} % | {:.4f} % | {} | {:.2f} |\n", name,
             leaf_count(*model.tree), seconds, report.is_valid ? "yes" : "no", report.solids, report.faces,
             report.volume, report.tree_volume, 100 * report.volume_difference(),
             100 * report.tree_volume_error / report.tree_volume, report.failed.size(),
             static_cast<double>(std::filesystem::file_size(file)) / 1e6);
  for (const FailedNode& failed : report.failed) fmt::print("|  failed: {}: {} |\n", failed.node, failed.reason);
  std::fflush(stdout);
  std::filesystem::remove(file);
}

void run(const std::vector<std::string>& files) {
  fmt::print(
      "| model | leaves | seconds | valid | solids | faces | volume | tree's volume | apart | its error | failed "
      "nodes | MB |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& file : files) print_row(std::filesystem::path(file).stem(), read_model(file));
  if (!files.empty()) return;
  for (const char* name : {"m0", "m1", "m2", "m3"}) {
    print_row(name, read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / (std::string(name) + ".json")));
  }
  for (const Family family : all_families()) {
    print_row(std::string(to_string(family)), make_family(family, {.primitives = 100}));
  }
}

}  // namespace
}  // namespace cloud2csg

int main(int argc, char** argv) {
  try {
    cloud2csg::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
