// The steps of the extraction one by one on one core, each with the machine's bound: necessary computation and memory
// traffic at rates measured in the same run. Takes Google Benchmark's options.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "micro/work.hpp"

namespace cloud2csg::bench {
namespace {

constexpr int k_repetitions = 9;
constexpr double k_least_seconds = 0.1;

/// Seconds per run of each benchmark, one entry per repetition.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      seconds[run.run_name.function_name].push_back(run.cpu_accumulated_time / static_cast<double>(run.iterations));
    }
  }

  std::map<std::string, std::vector<double>> seconds;
};

std::vector<Microbenchmark> all_benchmarks() {
  std::vector<Microbenchmark> all;
  for (const auto& group :
       {pass_benchmarks(), evaluation_benchmarks(), search_benchmarks(), clique_benchmarks(), tree_benchmarks()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

void register_all([[maybe_unused]] const std::vector<Microbenchmark>& all) {
#ifndef __clang_analyzer__  // which takes the registry of benchmarks for a leak
  for (const Microbenchmark& each : all) {
    benchmark::RegisterBenchmark(each.name.c_str(),
                                 [&each](benchmark::State& state) {
                                   for (auto _ : state) each.run();
                                 })
        ->Repetitions(k_repetitions)
        ->MinTime(k_least_seconds);
  }
#endif
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void print_machine(const ArithmeticRates& rates) {
  constexpr double k_giga = 1e-9;
  fmt::print(
      "This machine, one core, {}, in 1e9 a second: {:.0f} operations in single precision ({:.0f} fused "
      "multiply-adds), {:.1f} divisions,\n{:.1f} roots, {:.0f} minima of bytes.",
      instruction_set(), rates.single * k_giga, rates.fused * k_giga, rates.single_division * k_giga,
      rates.single_root * k_giga, rates.byte_extremum * k_giga);
  for (const auto& [name, footprint] : {std::pair{"16 kB", 1U << 14U}, {"1 MB", 1U << 20U}, {"64 MB", 1U << 26U}}) {
    fmt::print(" {}: {:.0f} bytes read, {:.0f} written.", name, measure_reading(footprint) * k_giga,
               measure_writing(footprint) * k_giga);
  }
  fmt::print("\n\n");
}

/// Cost of class building relative to the distances, which any method that looks at the points needs.
void print_pass_against_distances(const Collector& collector) {
  for (const char* model : {"m0", "m2"}) {
    const auto pass = collector.seconds.find(std::string("class_pass/") + model);
    const auto distances = collector.seconds.find(std::string("distances/") + model);
    if (pass == collector.seconds.end() || distances == collector.seconds.end()) continue;
    fmt::print("\nThe class pass of {} takes {:.1f} times its distances alone.", model,
               median_of(pass->second) / median_of(distances->second));
  }
  fmt::print("\n");
}

void print_row(const Microbenchmark& each, std::vector<double> seconds, const ArithmeticRates& rates) {
  std::ranges::sort(seconds);
  const double median = seconds[seconds.size() / 2] / each.work.units;
  const Bound bound = bound_of(each.work, rates);
  const auto percent = [&](double value) { return (value / each.work.units / median - 1) * 100; };
  constexpr double k_nano = 1e9;
  fmt::print("| {:29} | {:17} | {:10.4g} | {:+4.0f} % {:+4.0f} % | {:9.3g} | {:10} | {:9.3g} |\n", each.name,
             each.work.unit, median * k_nano, percent(seconds.front()), percent(seconds.back()), bound.seconds * k_nano,
             bound.by, median / bound.seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace cloud2csg::bench

int main(int argc, char** argv) {
  using namespace cloud2csg::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const ArithmeticRates rates = measure_arithmetic();
  print_machine(rates);
  const std::vector<Microbenchmark> all = all_benchmarks();
  register_all(all);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  fmt::print(
      "Nanoseconds a unit, median of {} repetitions and how far the least and the most are from it; the bound; "
      "how many times the bound\n\n",
      k_repetitions);
  fmt::print(
      "| benchmark                     | unit              | ns         | spread        | bound, ns | bound by   "
      "| ratio     |\n");
  fmt::print(
      "|-------------------------------|-------------------|------------|---------------|-----------|------------"
      "|-----------|\n");
  for (const Microbenchmark& each : all) {
    const auto found = collector.seconds.find(each.name);
    if (found != collector.seconds.end()) print_row(each, found->second, rates);
  }
  print_pass_against_distances(collector);
}
