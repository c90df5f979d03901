#include "manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "core/base/files.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

/// Text as roff takes it: no letters that mean something to it, no line that starts with a request.
std::string plain(const std::string& text) {
  std::string roff = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  roff = replaced(roff, "\n.", "\n\\&.");
  roff = replaced(roff, "\n'", "\n\\&'");
  return (roff.starts_with('.') || roff.starts_with('\'') ? "\\&" : "") + roff;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string upper_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string entry_text(const OptionEntry& option) {
  std::vector<std::string> names;
  names.reserve(option.names.size());
  for (const std::string& name : option.names) names.push_back(bold(name));
  std::string text = fmt::format(".TP\n{}{}\n{}", fmt::join(names, ", "),
                                 option.value.empty() ? "" : " " + italic(option.value), plain(option.help));
  if (!option.default_value.empty()) text += fmt::format("\n.br\nDefault: {}", plain(option.default_value));
  if (option.is_required) text += "\n.br\nMust be given.";
  return text + "\n";
}

std::string argument_text(const OptionEntry& argument) {
  return fmt::format(".TP\n{}\n{}\n", italic(argument.value), plain(argument.help));
}

std::string synopsis(const CommandEntry& command) {
  std::string text = bold(path_text(command));
  if (!command.commands.empty()) return text + " " + italic("COMMAND") + " ...";
  for (const OptionEntry& argument : command.arguments) text += " " + italic(argument.value);
  for (const OptionEntry& option : command.options) {
    if (option.is_required) text += fmt::format(" {} {}", bold(option.names.front()), italic(option.value));
  }
  return text + " [" + italic("OPTION") + "]...";
}

/// By group, in the order in which the groups come first.
std::string options_text(const CommandEntry& command) {
  std::vector<std::string> groups;
  for (const OptionEntry& option : command.options) {
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) groups.push_back(option.group);
  }
  std::string text;
  for (const std::string& group : groups) {
    if (groups.size() > 1) text += fmt::format(".SS {}\n", plain(group == "Options" ? "General" : group));
    for (const OptionEntry& option : command.options) {
      if (option.group == group) text += entry_text(option);
    }
  }
  return text;
}

std::string commands_text(const CommandEntry& command) {
  std::string text;
  for (const CommandEntry& inner : command.commands) {
    text += fmt::format(".TP\n{}(1)\n{}\n", bold(path_text(inner, "-")), plain(inner.summary));
  }
  return text;
}

std::string others(const CommandEntry& command, const CommandEntry& program) {
  std::string text;
  for (const CommandEntry* other : all_commands(program)) {
    if (other->path == command.path) continue;
    text += fmt::format("{}{}(1)", text.empty() ? "" : ",\n", bold(path_text(*other, "-")));
  }
  return text + "\n";
}

std::string section(const std::string& title, const std::string& text) {
  return text.empty() ? "" : fmt::format(".SH {}\n{}{}", title, text, text.ends_with('\n') ? "" : "\n");
}

constexpr const char* k_environment = R"(.TP
\fBNO_COLOR\fR
Set to anything but nothing: no colours on a terminal. There are never any elsewhere.
)";
constexpr const char* k_exit_status = R"(.TP
0
Done.
.TP
1
It could not be done; standard error says why, and what to do.
.TP
2
Wrong usage.
.TP
130
Interrupted twice.
)";

}  // namespace

std::string manual_page(const CommandEntry& command, const CommandEntry& program) {
  const std::string name = path_text(command, "-");
  std::string page =
      fmt::format(".TH {} 1 \"\" \"cloud2csg {}\" \"User Commands\"\n", plain(upper_case(name)), CLOUD2CSG_VERSION);
  page += section("NAME", fmt::format("{} \\- {}", plain(name), plain(command.summary)));
  page += section("SYNOPSIS", synopsis(command));
  page += section("DESCRIPTION", plain(replaced(command.notes, "\n\n", "\n")));
  std::string arguments;
  for (const OptionEntry& argument : command.arguments) arguments += argument_text(argument);
  page += section("ARGUMENTS", arguments);
  page += section("COMMANDS", commands_text(command));
  page += section("OPTIONS", options_text(command));
  if (!command.examples.empty()) page += section("EXAMPLES", ".nf\n" + plain(command.examples) + "\n.fi");
  page += section("ENVIRONMENT", k_environment);
  page += section("EXIT STATUS", k_exit_status);
  return page + section("SEE ALSO", others(command, program));
}

Command add_manual(CLI::App& program) {
  CLI::App* app = program.add_subcommand("manual", "Writes the pages of the manual, for the build");
  app->group("");  // nothing for users: they have the pages
  app->footer(example("  cloud2csg manual share/man/man1"));
  auto folder = std::make_shared<std::string>();
  app->add_option("folder", *folder, "Folder that is there")->check(file_name())->required()->type_name("DIR");
  return {.options = app, .run = [&program, folder](const std::stop_token& /*stop*/) {
            const CommandEntry all = catalogue_of(program);
            for (const CommandEntry* command : all_commands(all)) {
              const std::filesystem::path file = std::filesystem::path(*folder) / (path_text(*command, "-") + ".1");
              write_text_file(file, manual_page(*command, all));
            }
          }};
}

}  // namespace cloud2csg::app
