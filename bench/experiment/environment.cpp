#include <oneapi/tbb/info.h>

#include <fstream>
#include <string>

#include "bench/experiment/paper.hpp"

#ifndef CLOUD2CSG_VERSION
#error "the build names the version"
#endif

namespace cloud2csg {
namespace {

std::string compiler_name() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Environment current_environment() {
  return {.version = CLOUD2CSG_VERSION,
          .compiler = compiler_name(),
          .cpu = cpu_model(),
          .cores = oneapi::tbb::info::default_concurrency()};
}

}  // namespace cloud2csg
