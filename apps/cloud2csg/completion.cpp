#include "completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "command.hpp"
#include "values.hpp"

namespace cloud2csg::app {

std::string quoted(const std::string& text, const std::string& quote) {
  return "'" + replaced(text, "'", quote) + "'";
}

std::vector<std::string> argument_endings(const CommandEntry& command) {
  std::vector<std::string> endings;
  for (const OptionEntry& argument : command.arguments) {
    for (const std::string& ending : argument.endings) {
      if (std::find(endings.begin(), endings.end(), ending) == endings.end()) endings.push_back(ending);
    }
  }
  return endings;
}

Command add_completion(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("completion", "Prints a script that completes commands and options in a shell");
  app->footer("Installed packages have these scripts where the shells look for them.\n\n" +
              example("  cloud2csg completion bash > ~/.local/share/bash-completion/completions/cloud2csg\n"
                      "  cloud2csg completion zsh > ~/.zfunc/_cloud2csg\n"
                      "  cloud2csg completion fish > ~/.config/fish/completions/cloud2csg.fish"));
  auto shell = std::make_shared<std::string>();
  app->add_option("shell", *shell, "bash, zsh or fish")
      ->check(one_of({"bash", "zsh", "fish"}))
      ->required()
      ->type_name("SHELL");
  return {.options = app, .run = [&program, shell](const std::stop_token& /*stop*/) {
            const CommandEntry all = catalogue_of(program);
            fmt::print("{}", *shell == "bash"  ? bash_completion(all)
                             : *shell == "zsh" ? zsh_completion(all)
                                               : fish_completion(all));
          }};
}

}  // namespace cloud2csg::app
