#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "command.hpp"
#include "config_file.hpp"
#include "installation.hpp"
#include "interrupt.hpp"
#include "usage.hpp"

namespace cloud2csg::app {
namespace {

constexpr int k_done = 0;
constexpr int k_failed = 1;
constexpr int k_wrong_usage = 2;

int complain(int status, std::string_view message) {
  fmt::print(stderr, "cloud2csg: {}\n", message);
  return status;
}

void describe(CLI::App& program) {
  program.description("Turns a point cloud of a solid object into an editable CSG tree.");
  program.name("cloud2csg");
  program.set_version_flag("--version", version_text(), "Print the version, and what is built in, and exit");
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.get_formatter()->column_width(34);
  program.footer(example("  cloud2csg extract scan.ply -o part.scad -o report.html\n"
                         "  cloud2csg extract scan.ply --config part.toml -o part.step\n"
                         "  cloud2csg convert part.json -o part.stl") +
                 "\n\n'cloud2csg COMMAND --help' explains a command.\n"
                 "Results go to files and standard output, progress and messages to standard error.\n"
                 "Exit status: 0 done, 1 could not do it, 2 wrong usage, 130 interrupted twice.");
}

int run_command(const Command& command) {
  const InterruptWatcher interrupts;
  command.run(interrupts.token());
  if (std::fflush(stdout) != 0) return complain(k_failed, "standard output cannot be written");
  return k_done;
}

int run(int argc, char** argv) {
  CLI::App program;
  describe(program);
  const std::vector<Command> commands{add_extract(program), add_detect(program),     add_sample(program),
                                      add_scan(program),    add_compare(program),    add_convert(program),
                                      add_view(program),    add_info(program),       add_bench(program),
                                      add_doctor(program),  add_completion(program), add_manual(program)};
  try {
    program.parse(argc, argv);
  } catch (const PrintedConfig& asked) {
    fmt::print("{}", asked.what());
    return k_done;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    return complain(k_wrong_usage, usage_message(program, error));
  }
  for (const Command& command : commands) {
    if (command.options->parsed()) return run_command(command);
  }
  fmt::print(stderr, "{}", program.help());
  return k_wrong_usage;
}

}  // namespace
}  // namespace cloud2csg::app

int main(int argc, char** argv) {
  using namespace cloud2csg;
  // A limit on the size of files is then an error of writing like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);  // and a reader that went away likewise
  try {
    return app::run(argc, argv);
  } catch (const Cancelled&) {
    return app::complain(app::k_failed, "interrupted");
  } catch (const std::bad_alloc&) {
    return app::complain(app::k_failed, "not enough memory");
  } catch (const std::exception& error) {
    return app::complain(app::k_failed, error.what());
  }
}
