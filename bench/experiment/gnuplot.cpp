#include "bench/experiment/gnuplot.hpp"

#include <chrono>
#include <string>

#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "core/base/run_program.hpp"

namespace cloud2csg {
namespace {

/// The last non-empty line, in which gnuplot names the error.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return "it does not say why";
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t start = before == std::string::npos ? 0 : before + 1;
  return text.substr(start, end + 1 - start);
}

}  // namespace

bool run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& picture) {
  constexpr std::chrono::seconds k_limit(600);
  const TemporaryFile complaint(picture, ".txt");
  const RunEnd end = run_program({"gnuplot", script.string()}, picture, complaint.path(), k_limit);
  if (end == RunEnd::not_installed) return false;
  if (end != RunEnd::done) {
    throw Error(
        {.file = script.string(), .expected = "gnuplot failed: " + last_line(read_text_file(complaint.path()))});
  }
  return true;
}

}  // namespace cloud2csg
