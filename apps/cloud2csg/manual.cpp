#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "catalogue.hpp"
#include "command.hpp"
#include "core/base/files.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

/// Escapes text for roff: special letters and lines that start with a request.
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
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string entry_text(const CLI::Option& option) {
  std::vector<std::string> names = dashed_names(option);
  for (std::string& name : names) name = bold(name);
  std::string text =
      fmt::format(".TP\n{}{}\n{}", fmt::join(names, ", "),
                  takes_value(option) ? " " + italic(option.get_type_name()) : "", plain(option.get_description()));
  if (!option.get_default_str().empty()) text += fmt::format("\n.br\nDefault: {}", plain(option.get_default_str()));
  if (option.get_required()) text += "\n.br\nRequired.";
  return text + "\n";
}

std::string arguments_text(CLI::App& command) {
  std::string text;
  for (const CLI::Option* const argument : arguments_of(command)) {
    text += fmt::format(".TP\n{}\n{}\n", italic(argument->get_type_name()), plain(argument->get_description()));
  }
  return text;
}

std::string synopsis(CLI::App& command) {
  std::string text = bold(path_text(command));
  if (!commands_of(command).empty()) return text + " " + italic("COMMAND") + " ...";
  for (const CLI::Option* const argument : arguments_of(command)) text += " " + italic(argument->get_type_name());
  for (const CLI::Option* const option : options_of(command)) {
    if (!option->get_required()) continue;
    text += fmt::format(" {} {}", bold(dashed_names(*option).front()), italic(option->get_type_name()));
  }
  return text + " [" + italic("OPTION") + "]...";
}

std::string options_text(CLI::App& command) {
  const std::vector<CLI::Option*> options = options_of(command);
  const bool has_groups = options.front()->get_group() != options.back()->get_group();
  std::string text;
  std::string group;
  for (const CLI::Option* const option : options) {
    if (has_groups && option->get_group() != group) {
      group = option->get_group();
      text += fmt::format(".SS {}\n", plain(group == "Options" ? "General" : group));
    }
    text += entry_text(*option);
  }
  return text;
}

std::string commands_text(CLI::App& command) {
  std::string text;
  for (const CLI::App* const inner : commands_of(command)) {
    text += fmt::format(".TP\n{}(1)\n{}\n", bold(path_text(*inner, "-")), plain(inner->get_description()));
  }
  return text;
}

std::string others(const CLI::App& command, CLI::App& program) {
  std::string text;
  for (const CLI::App* const other : all_commands(program)) {
    if (other == &command) continue;
    text += fmt::format("{}{}(1)", text.empty() ? "" : ",\n", bold(path_text(*other, "-")));
  }
  return text + "\n";
}

std::string section(const std::string& title, const std::string& text) {
  return text.empty() ? "" : fmt::format(".SH {}\n{}{}", title, text, text.ends_with('\n') ? "" : "\n");
}

constexpr const char* k_environment = R"(.TP
\fBNO_COLOR\fR
If set and not empty: no colours on a terminal. There are never colours elsewhere.
)";
constexpr const char* k_exit_status = R"(.TP
0
Success.
.TP
1
Failure; standard error says why, and what to do.
.TP
2
Wrong usage.
.TP
130
Interrupted twice.
)";

/// The command's manual page in roff.
std::string manual_page(CLI::App& command, CLI::App& program) {
  const std::string name = path_text(command, "-");
  const std::string footer = command.get_footer();
  const std::size_t end = footer.find(example(""));
  std::string notes = footer.substr(0, end);
  while (notes.ends_with('\n')) notes.pop_back();
  std::string page =
      fmt::format(".TH {} 1 \"\" \"cloud2csg {}\" \"User Commands\"\n", plain(upper_case(name)), CLOUD2CSG_VERSION);
  page += section("NAME", fmt::format("{} \\- {}", plain(name), plain(command.get_description())));
  page += section("SYNOPSIS", synopsis(command));
  page += section("DESCRIPTION", plain(replaced(notes, "\n\n", "\n")));
  page += section("ARGUMENTS", arguments_text(command));
  page += section("COMMANDS", commands_text(command));
  page += section("OPTIONS", options_text(command));
  if (end != std::string::npos) {
    page += section("EXAMPLES", ".nf\n" + plain(footer.substr(end + example("").size())) + "\n.fi");
  }
  page += section("ENVIRONMENT", k_environment);
  page += section("EXIT STATUS", k_exit_status);
  return page + section("SEE ALSO", others(command, program));
}

}  // namespace

Command add_manual(CLI::App& program) {
  CLI::App* app = program.add_subcommand("manual", "Writes the pages of the manual, for the build");
  app->group("");  // hidden: users have the built pages
  app->footer(example("  cloud2csg manual share/man/man1"));
  auto folder = std::make_shared<std::string>();
  app->add_option("folder", *folder, "Existing folder")->check(file_name())->required()->type_name("DIR");
  return {.options = app, .run = [&program, folder](const std::stop_token& /*stop*/) {
            for (CLI::App* const command : all_commands(program)) {
              const std::filesystem::path file = std::filesystem::path(*folder) / (path_text(*command, "-") + ".1");
              write_text_file(file, manual_page(*command, program));
            }
            return k_done;
          }};
}

}  // namespace cloud2csg::app
