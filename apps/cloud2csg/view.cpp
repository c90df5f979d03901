#include "cloud2csg/view.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "cloud2csg/input.hpp"
#include "command.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "page_server.hpp"

namespace cloud2csg::app {
namespace {

struct ViewCommand {
  std::string model;
  std::string cloud;  // empty: none
  int port = 0;
  bool no_browser = false;
  RunOptions running;
  std::vector<ReportParameter> parameters;

  void settle(const CLI::App& app) { parameters = parameters_of(app); }
  void run(const std::stop_token& stop) const;
  [[nodiscard]] Report report(const RunContext& run) const;
};

Report ViewCommand::report(const RunContext& run) const {
  Report report{
      .title = std::filesystem::path(model).filename().string(), .model = read_model(model), .parameters = parameters};
  (void)tree_of(report.model, model);
  report.source = report.model.description;
  report.warnings = report.model.warnings;
  if (cloud.empty()) return report;
  Input input = read_cloud_or_mesh(cloud, {}, run);
  report.cloud = std::move(input.cloud);
  report.warnings.insert(report.warnings.end(), input.warnings.begin(), input.warnings.end());
  return report;
}

void ViewCommand::run(const std::stop_token& stop) const {
  check_report_page(model);
  std::string page;
  {
    const Session session(running, stop);
    page = naming(model, [&] { return report_page(report(session.run()), {}, session.run()); });
  }
  serve_page(page, port, stop, [this](const std::string& address) {
    fmt::print("{}\n", address);
    (void)std::fflush(stdout);
    const bool is_opened = !no_browser && open_in_browser(address);
    if (running.quiet) return;
    fmt::print(stderr, "{}press Ctrl-C to end\n",
               is_opened ? "opened in the browser; " : "open this address in a browser; ");
  });
}

void add_options(CLI::App& app, ViewCommand& command, FieldArguments& /*fields*/) {
  add_file(app, "model", command.model, "Model file with a tree: " + endings_read({FileKind::model}))
      ->type_name("MODEL");
  app.add_option("--cloud", command.cloud,
                 "Points to show beside the solid, with their distances from it: " +
                     endings_read({FileKind::cloud, FileKind::mesh}))
      ->check(file_name())
      ->type_name("CLOUD|MESH");
  app.add_option("--port", command.port, "Port on 127.0.0.1; 0 = any free port")
      ->transform(number_in<int>(from_to(0, 65'535)))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--no-browser", command.no_browser, "Print the address, but do not open a browser");
}

}  // namespace

Command add_view(CLI::App& program) {
  CLI::App* app = program.add_subcommand("view", "Shows a model in the browser, with a cloud beside it");
  app->footer("Shows the page that '-o report.html' writes, to this machine only, until Ctrl-C.\n\n" +
              example("  cloud2csg view bracket.json --cloud bracket.ply"));
  return make_command<ViewCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
