#include "command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

/// The path from the program to the named command.
std::vector<const CLI::App*> chosen(const CLI::App& program) {
  std::vector<const CLI::App*> path{&program};
  while (!path.back()->get_subcommands().empty()) path.push_back(path.back()->get_subcommands().front());
  return path;
}

std::vector<std::string> known_names(const CLI::App& app, bool options) {
  std::vector<std::string> names;
  if (options) {
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  } else {
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(command->get_name());
    }
  }
  return names;
}

std::string unknown_argument(const CLI::App& app, std::string word) {
  const bool is_option = word.size() > 1 && word.front() == '-';
  if (is_option) word = word.substr(0, word.find('='));
  const std::vector<std::string> names = known_names(app, is_option);
  const char* kind = is_option ? "unknown option" : names.empty() ? "unexpected argument" : "unknown command";
  return fmt::format("{} '{}'{}", kind, word, suggestion(word, names));
}

/// Number of inserted, deleted, replaced or swapped letters between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment of the first i letters of a and the first j of b.
  std::vector<std::vector<std::size_t>> steps(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& least = steps[i][j] = std::max(i, j);
      if (i == 0 || j == 0) continue;
      const bool is_same = a[i - 1] == b[j - 1];
      least = std::min({steps[i - 1][j] + 1, steps[i][j - 1] + 1, steps[i - 1][j - 1] + (is_same ? 0 : 1)});
      const bool is_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swapped) least = std::min(least, steps[i - 2][j - 2] + 1);
    }
  }
  return steps[a.size()][b.size()];
}

}  // namespace

void add_run_options(CLI::App& options, RunOptions& values) {
  options.add_option("--threads", values.threads, "Number of threads; 0 = all cores")
      ->transform(number_in<int>(from_to(0, 1024)))
      ->type_name("N")
      ->group("Running")
      ->capture_default_str();
  options.add_flag("-q,--quiet", values.quiet, "Do not print progress and summaries to standard error")
      ->group("Running");
  add_config_options(options);
}

CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings) {
  return options
      .add_option("-o,--output", files,
                  fmt::format("File to write; the ending selects the format: {}; may be repeated", endings))
      ->check(file_name())
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
}

CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help) {
  return options.add_option(name, file, help)->check(file_name())->required();
}

void add_shape(CLI::App& options, std::string& file) {
  const std::string help =
      "Model file with a tree: " + endings_read({FileKind::model}) + ", or mesh: " + endings_read({FileKind::mesh});
  add_file(options, "shape", file, help)->type_name("MODEL|MESH");
}

const char* taker_of(FileKind kind) {
  switch (kind) {
    case FileKind::cloud:
      return "'extract' makes a model from it, 'detect' finds its solids, 'compare' and 'info' also read it";
    case FileKind::mesh:
      return "'extract' makes a model from it, 'sample' makes a cloud, 'compare' and 'info' also read it";
    case FileKind::model:
      return "'convert' writes it in other formats, 'sample' makes a cloud from it, 'info' describes it";
    case FileKind::script:
      return "no command reads it; 'convert' takes the .json that it was written from";
    case FileKind::solid:
      return "no command reads it; export a mesh from the CAD program, from which 'extract' makes a model";
    case FileKind::graph:
      return "no command reads it; Graphviz draws it";
    case FileKind::page:
      return "no command reads it; a browser shows it";
    case FileKind::picture:
      return "no command reads it; 'convert' writes such files";
    case FileKind::statistics:
      return "no command reads it; 'extract --stats' writes such files";
  }
  return "";
}

bool lacks_command(const CLI::App& program) {
  const CLI::App& last = *chosen(program).back();
  const auto is_any = [](const CLI::App* /*command*/) { return true; };
  return last.remaining().empty() && !last.get_subcommands(is_any).empty();
}

std::string reworded(const CLI::ParseError& error) {
  std::string text = error.what();
  const std::string option = text.substr(0, text.find(": "));
  if (error.get_name() == "ArgumentMismatch" && text.ends_with(" missing")) {
    return fmt::format("{}: expected a value, found none", option);
  }
  if (error.get_name() == "ArgumentMismatch" && text.find("At Most") != std::string::npos) {
    return fmt::format("{}: given more than once", option);
  }
  if (error.get_name() == "ConversionError") return fmt::format("{}; a flag takes no value", text);
  if (error.get_name() == "ExcludesError") return fmt::format("{}: give one of the two", text);
  return text;
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
  std::string nearest;
  // A third of the letters may be wrong.
  std::size_t best = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const bool abbreviates = word.size() >= 4 && candidate.starts_with(word);
    const std::size_t distance = abbreviates ? 1 : edit_distance(word, candidate);
    if (distance < best) best = distance, nearest = candidate;
  }
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> path = chosen(program);
  const CLI::App& app = *path.back();
  // A misspelt option is also the cause of a missing required one.
  const std::vector<std::string> unknown = app.remaining();
  const std::string what = unknown.empty() ? reworded(error) : unknown_argument(app, unknown.front());
  std::string name = program.get_name();
  for (std::size_t i = 1; i < path.size(); ++i) name += ' ' + path[i]->get_name();
  return fmt::format("{} (see '{} --help')", what, name);
}

std::string example(const std::string& lines) {
  return "Example:\n" + lines;
}

}  // namespace cloud2csg::app
