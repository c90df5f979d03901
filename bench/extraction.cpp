// Seconds of the extraction's stages on one core, growth with the number of points, and memory of the process.

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "cloud2csg/extract.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {
namespace {

/// Peak resident size of this process, in MB.
double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  }
  return std::nan("");
}

ExtractStatistics median_run(const PointCloud& cloud, const Model& model, const ExtractOptions& options,
                             std::size_t runs) {
  std::vector<ExtractStatistics> all;
  for (std::size_t run = 0; run < runs; ++run) all.push_back(extract_csg(cloud, model.primitives, options).statistics);
  std::ranges::sort(all, {}, [](const ExtractStatistics& s) { return s.seconds.extraction; });
  return all[all.size() / 2];
}

void stages(const std::string& name, const ExtractOptions& options) {
  const Model model = shipped_model(name);
  const PointCloud cloud = paper_cloud(model, 150'000, 1);
  const ExtractStatistics s = median_run(cloud, model, options, 15);
  const auto ms = [](double seconds) { return seconds * 1e3; };
  fmt::print("| {:5} | {:10} | {:8.1f} | {:8.2f} | {:8.1f} | {:8.1f} | {:8.2f} | {:8.2f} | {:10.1f} | {:9}/{:<3} |\n",
             name, to_string(options.strategy), ms(s.seconds.segment), ms(s.seconds.overlap + s.seconds.partition),
             ms(s.seconds.classes), ms(s.seconds.search), ms(s.seconds.merge), ms(s.seconds.simplify),
             ms(s.seconds.extraction), s.tree.size, model.tree->size());
}

void growth(const std::string& name) {
  const Model model = shipped_model(name);
  ExtractOptions options;
  options.parallel = Parallel::none;
  double first_points = 0;
  double first_seconds = 0;
  for (const std::size_t points : {10'000U, 100'000U, 1'000'000U, 10'000'000U}) {
    const PointCloud cloud = paper_cloud(model, points, 1);
    const double seconds = median_run(cloud, model, options, points > 1'000'000 ? 3 : 9).seconds.extraction;
    const auto count = static_cast<double>(points);
    if (first_points == 0) {
      first_points = count;
      first_seconds = seconds;
    }
    const double exponent =
        count > first_points ? std::log(seconds / first_seconds) / std::log(count / first_points) : 0;
    fmt::print("| {:5} | {:10} | {:12.1f} | {:14.1f} | {:8.2f} |\n", name, points, seconds * 1e3, seconds / count * 1e9,
               exponent);
  }
}

}  // namespace
}  // namespace cloud2csg::bench

int main() {
  using namespace cloud2csg;
  using namespace cloud2csg::bench;
  fmt::print("Extraction, 150 000 points, noise 0.01, one core, the run of median duration of 15, milliseconds\n\n");
  fmt::print(
      "| model | strategy   | segment  | overlap  | classes  | search   | merge    | simplify | extraction | "
      "nodes/true    |\n");
  fmt::print(
      "|-------|------------|----------|----------|----------|----------|----------|----------|------------|-----------"
      "----|\n");
  for (const char* name : {"m0", "m1", "m2", "m3"}) {
    ExtractOptions options;
    options.parallel = Parallel::none;
    stages(name, options);
    options.strategy = Strategy::partition;
    stages(name, options);
  }
  fmt::print("\nPeak memory of this process up to here: {:.0f} MB, clouds and sampling included\n\n", peak_memory_mb());
  fmt::print("Growth with the number of points, one core, medians; exponent against the first row\n\n");
  fmt::print("| model | points     | extraction, ms | ns a point   | exponent |\n");
  fmt::print("|-------|------------|--------------|----------------|----------|\n");
  for (const char* name : {"m0", "m2"}) growth(name);
}
