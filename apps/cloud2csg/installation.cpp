#include "installation.hpp"

#include <fmt/format.h>
#include <hwy/targets.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "bench/experiment/paper.hpp"
#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/view.hpp"
#include "command.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::string_view k_fine = "ok";
constexpr std::string_view k_absent = "absent";  // left out; most features work without it
constexpr std::string_view k_broken = "BROKEN";  // should be present

/// The state of a part of the installation.
struct Finding {
  std::string_view state;
  std::string part, text, remedy = {};
};

/// The widest compiled instruction set that the processor supports: Highway's lowest bit.
std::string instruction_set() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return usable == 0 ? "none" : hwy::TargetName(usable & -usable);
}

Finding cad_files() {
  const BrepSupport support = brep_support();
  const std::string part = "CAD files";
  if (!support.fault.empty()) {
    const bool is_broken = support.is_built_in && !support.lacks_opencascade;
    return {is_broken ? k_broken : k_absent, part, "no .step, .brep: " + support.fault, support.remedy};
  }
  return {k_fine, part, ".step, .brep by OpenCASCADE: " + support.module.string()};
}

Finding reports() {
  if (has_report_page()) return {k_fine, "reports", ".html and 'view' are built in"};
  return {k_absent, "reports", "not built in: no .html, no 'view'",
          "install Node.js 18 or later with npm, and build again with -DCLOUD2CSG_VIEWER=ON"};
}

Finding helper(const std::string& part, const std::string& name, const std::string& without,
               const std::string& package) {
  const char* const search_path = std::getenv("PATH");
  const auto found = find_program(name, search_path != nullptr ? search_path : "");
  if (found) return {k_fine, part, found->string()};
  return {k_absent, part, fmt::format("'{}' is not found: {}", name, without), "install " + package};
}

Finding models() {
  const auto folder = shipped_models();
  if (folder) return {k_fine, "models", folder->string()};
  return {k_broken, "models", "the shipped models are not beside the program: 'bench paper' needs --models",
          "install cloud2csg again"};
}

/// Examines all parts; takes as long as loading OpenCASCADE.
std::vector<Finding> examine_installation() {
  const Environment here = current_environment();
  return {{k_fine, "cloud2csg", fmt::format("{}, built by {}", here.version, here.compiler)},
          {k_fine, "processor",
           fmt::format("{}; {} thread{}; instruction set {}", here.cpu, here.cores, here.cores == 1 ? "" : "s",
                       instruction_set())},
          cad_files(),
          reports(),
          models(),
          helper("OpenSCAD", "openscad", "written .scad files cannot be opened here", "openscad"),
          helper("FreeCAD", "freecadcmd", "written .FCMacro and .step files cannot be opened here", "freecad"),
          helper("gnuplot", "gnuplot", "'bench' makes tables but no figures", "gnuplot-nox"),
          helper("browser", "xdg-open", "'view' prints the address only", "xdg-utils")};
}

void examine() {
  const std::vector<Finding> findings = examine_installation();
  for (const Finding& finding : findings) {
    fmt::print("{:<7} {:<10} {}{}\n", finding.state, finding.part, finding.text,
               finding.remedy.empty() ? "" : "; " + finding.remedy);
  }
  const auto broken = std::ranges::find(findings, k_broken, &Finding::state);
  if (broken == findings.end()) return;
  throw Error({.where = broken->part, .expected = broken->text, .remedy = broken->remedy});
}

}  // namespace

std::optional<std::filesystem::path> find_program(const std::string& name, const std::string& search_path) {
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> shipped_models() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (const char* place : {CLOUD2CSG_MODELS_FROM_PROGRAM, "share/cloud2csg/models"}) {
    std::filesystem::path folder = (program.parent_path() / place).lexically_normal();
    if (std::filesystem::is_directory(folder, ignored)) return folder;
  }
  return std::nullopt;
}

std::string version_text() {
  const auto mark = [](bool is_there) { return is_there ? '+' : '-'; };
  return fmt::format("cloud2csg {}\nfeatures: {}step {}brep {}html {}view", CLOUD2CSG_VERSION, mark(is_brep_built_in()),
                     mark(is_brep_built_in()), mark(has_report_page()), mark(has_report_page()));
}

Command add_doctor(CLI::App& program) {
  CLI::App* app = program.add_subcommand("doctor", "Reports which optional parts are installed, and what is broken");
  app->footer(
      "'absent' marks parts that this program was built without, or that are not installed. Exit status 1 means that "
      "something is broken.\n\n" +
      example("  cloud2csg doctor"));
  return {.options = app, .run = [](const std::stop_token& /*stop*/) {
            examine();
            return k_done;
          }};
}

}  // namespace cloud2csg::app
