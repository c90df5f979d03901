#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// The name of a field in words: "low points".
[[nodiscard]] inline std::string spaced(std::string_view field) {
  std::string words(field);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// Refuses to combine runs that are not comparable.
class ResumeCheck {
 public:
  explicit ResumeCheck(const std::filesystem::path& file) : file_(file) {}

  template <typename Value>
  void same(std::string_view what, const Value& there, const Value& now) const {
    if (there == now) return;
    throw Error({.file = file_.string(),
                 .expected = fmt::format("holds results with {} {}, not {}", what, there, now),
                 .remedy = "choose another folder, or remove this one"});
  }

  template <HasOptionTable Options>
  void same_options(const Options& there, const Options& now) const {
    for_each_field<Options>([&](auto member, const OptionField& field) {
      same(spaced(field.name), value_text(there.*member), value_text(now.*member));
    });
  }

  void same_environment(const Environment& there, const Environment& now) const {
    same("version", there.version, now.version);
    same("compiler", there.compiler, now.compiler);
    same("cpu", there.cpu, now.cpu);
    same("cores", there.cores, now.cores);
  }

 private:
  const std::filesystem::path& file_;
};

}  // namespace cloud2csg
