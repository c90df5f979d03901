#include <fmt/format.h>

#include <algorithm>

#include "cloud2csg/error.hpp"
#include "command.hpp"
#include "installation.hpp"

namespace cloud2csg::app {
namespace {

const char* word_of(Finding::State state) {
  switch (state) {
    case Finding::State::fine:
      return "ok";
    case Finding::State::absent:
      return "absent";
    case Finding::State::broken:
      return "BROKEN";
  }
  return "";
}

void examine() {
  const std::vector<Finding> findings = examine_installation();
  for (const Finding& finding : findings) {
    fmt::print("{:<7} {:<10} {}{}\n", word_of(finding.state), finding.part, finding.text,
               finding.remedy.empty() ? "" : "; " + finding.remedy);
  }
  const auto broken = std::find_if(findings.begin(), findings.end(),
                                   [](const Finding& finding) { return finding.state == Finding::State::broken; });
  if (broken == findings.end()) return;
  throw Error({.where = broken->part, .expected = broken->text, .remedy = broken->remedy});
}

}  // namespace

Command add_doctor(CLI::App& program) {
  CLI::App* app = program.add_subcommand("doctor", "Says which optional parts are there, and what is broken");
  app->footer(
      "'absent' is what this program was built without, or what is not installed here; exit status 1 says that "
      "something is broken.\n\n" +
      example("  cloud2csg doctor"));
  return {.options = app, .run = [](const std::stop_token& /*stop*/) { examine(); }};
}

}  // namespace cloud2csg::app
