#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "command.hpp"
#include "core/base/text.hpp"
#include "installation.hpp"
#include "session.hpp"

namespace cloud2csg::app {
namespace {

void put_line(std::string_view text) {
  const std::string line = visible_text(text) + "\n";
  std::fputs(line.c_str(), stderr);  // does not throw when nobody reads it
}

int complain(int status, const std::string& message) {
  put_line("cloud2csg: " + message);
  return status;
}

/// Ends silently by SIGPIPE when the reader has gone, like other tools.
void end_if_unread(int error_number) {
  if (error_number != EPIPE) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

/// Exit status after flushing standard output.
int flushed() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return k_done;
  end_if_unread(errno);
  return complain(k_failed, "standard output cannot be written");
}

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0) end_if_unread(errno);
  return flushed();
}

void describe(CLI::App& program) {
  program.description("Turns a point cloud of a solid object into an editable CSG tree.");
  program.name("cloud2csg");
  program.set_version_flag("--version", version_text(), "Print the version and the built-in features, and exit");
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.get_formatter()->column_width(34);
  program.footer(example("  cloud2csg extract scan.ply -o part.scad -o report.html\n"
                         "  cloud2csg extract scan.ply --config part.toml -o part.step\n"
                         "  cloud2csg convert part.json -o part.stl") +
                 "\n\n'cloud2csg COMMAND --help', or 'cloud2csg help COMMAND', explains a command.\nResults go to "
                 "files and standard output, progress and messages to standard error.\nExit status: 0 success, 1 "
                 "failure, 2 wrong usage, 3 a doubtful result, 130 interrupted twice.");
}

/// What is told of the exception being handled.
struct Failure {
  int status;
  std::string message;
  std::vector<std::string> warnings = {};
};

Failure current_failure() {
  try {
    throw;
  } catch (const Cancelled&) {
    return {k_failed, "interrupted"};
  } catch (const WrongUsage& error) {
    return {k_wrong_usage, error.what()};
  } catch (const WrongFile& error) {
    return {k_failed, fmt::format("{}; {}", error.what(), taker_of(error.found()))};
  } catch (const Error& error) {
    return {k_failed, error.what(), error.parts().warnings};
  } catch (const std::bad_alloc&) {
    return {k_failed, "not enough memory"};
  } catch (const std::system_error& error) {
    end_if_unread(error.code().value());
    return {k_failed, error.what()};
  } catch (const std::exception& error) {
    return {k_failed, error.what()};
  }
}

int run_command(const Command& command) {
  const InterruptWatcher interrupts;
  try {
    const int status = command.run(interrupts.token());
    const int written = flushed();
    return written == k_done ? status : written;
  } catch (...) {
    const Failure failure = current_failure();
    for (const std::string& warning : failure.warnings) put_line("warning: " + warning);
    complain(failure.status, failure.message);
    if (command.fail && failure.status == k_failed) command.fail(failure.message);
    (void)flushed();
    return failure.status;
  }
}

/// The words of the command line; "help extract" becomes "extract --help".
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

int print_asked(const CLI::App& program, const CLI::ParseError& asked) {
  std::ostringstream text;
  program.exit(asked, text, text);
  return print(text.str());
}

/// Prints the commands when none was chosen.
int explain(const CLI::App& program) {
  std::fputs(program.help().c_str(), stderr);
  return k_wrong_usage;
}

int run(int argc, char** argv) {
  CLI::App program;
  describe(program);
  const std::vector<Command> commands{add_extract(program), add_detect(program),     add_sample(program),
                                      add_scan(program),    add_compare(program),    add_convert(program),
                                      add_view(program),    add_info(program),       add_bench(program),
                                      add_doctor(program),  add_completion(program), add_manual(program)};
  std::vector<std::string> words = words_of(argc, argv);
  // Not parsed, since a shell may pass any words.
  if (!words.empty() && words.front() == "complete") return print(completions(program, std::span(words).subspan(1)));
  try {
    std::reverse(words.begin(), words.end());  // CLI11 expects reverse order
    program.parse(std::move(words));
  } catch (const PrintedConfig& asked) {
    return print(asked.what());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return print_asked(program, error);
    if (lacks_command(program)) return explain(program);
    return complain(k_wrong_usage, usage_message(program, error));
  }
  for (const Command& command : commands) {
    if (command.options->parsed()) return run_command(command);
  }
  return explain(program);
}

}  // namespace
}  // namespace cloud2csg::app

int main(int argc, char** argv) {
  using namespace cloud2csg;
  // A file size limit then causes a write error, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe likewise
  try {
    return app::run(argc, argv);
  } catch (...) {
    const app::Failure failure = app::current_failure();
    return app::complain(failure.status, failure.message);
  }
}
