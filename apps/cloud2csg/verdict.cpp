#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "command.hpp"

namespace cloud2csg::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_told_regions = 5;

void print_json(Json verdict, std::span<const std::string> files) {
  verdict["files"] = files;
  // Names of files need not be UTF-8.
  const std::string line = verdict.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::fputs(line.c_str(), stdout);  // an error shows when standard output is flushed
}

}  // namespace

void add_json_option(CLI::App& options, bool& json) {
  options
      .add_flag(
          "--json", json,
          "Print the verdict, the figures behind it and the files written, as a last line of JSON on standard output")
      ->group("Output");
}

int tell_verdict(Session& session, const ExtractStatistics& statistics, std::span<const std::string> files, bool json) {
  const std::vector<std::string> regions = region_lines(statistics.verdict);
  const std::size_t told = std::min(regions.size(), k_told_regions);
  for (const std::string& line : std::span(regions).first(told)) session.display().note(line);
  if (told < regions.size()) session.display().note(fmt::format("and {} smaller regions", regions.size() - told));
  const bool is_failed = statistics.verdict.grade == Grade::failed;
  session.display().say(to_text(statistics.verdict) + (is_failed ? "; nothing was written" : ""));
  if (json) print_json(Json::parse(to_json(statistics.verdict)), files);
  switch (statistics.verdict.grade) {
    case Grade::good:
      return k_done;
    case Grade::doubtful:
      return k_doubtful;
    case Grade::failed:
      break;
  }
  return k_failed;
}

void tell_failure(std::string_view message) {
  const Verdict verdict{.grade = Grade::failed, .doubts = {std::string(message)}};
  print_json(Json::parse(to_json(verdict)), {});
}

}  // namespace cloud2csg::app
