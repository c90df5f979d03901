#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/resume_check.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

Model read_true_model(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / (name + ".json");
  Model model = read_model(file);
  if (!model.tree) {
    throw Error({.file = file.string(),
                 .where = "/tree",
                 .expected = "the model has no tree, from which a cloud is made",
                 .remedy = "give a model with a tree"});
  }
  return model;
}

/// FNV-1a hash of the model's text.
std::string fingerprint(const Model& model) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : to_json(model)) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

ModelDetails details_of(const std::string& name, const Model& model) {
  return {.name = name,
          .primitives = model.primitives.size(),
          .tree = statistics_of(*model.tree, model.primitives),
          .fingerprint = fingerprint(model)};
}

void check_same_experiment(const std::filesystem::path& file, const PaperResults& there, const PaperResults& now) {
  const ResumeCheck check(file);
  check.same_options(there.options, now.options);
  check.same_environment(there.environment, now.environment);
  const auto same_model = [](const ModelDetails& x, const ModelDetails& y) { return x.fingerprint == y.fingerprint; };
  if (!std::equal(there.models.begin(), there.models.end(), now.models.begin(), now.models.end(), same_model)) {
    throw Error({.file = file.string(),
                 .where = "/models",
                 .expected = "holds results of other models of the same names",
                 .remedy = "choose another folder, or remove this one"});
  }
}

}  // namespace

PaperResults reproduce_paper(const PaperOptions& options, const std::filesystem::path& models,
                             const std::filesystem::path& folder, const RunContext& run) {
  validate(options);
  PaperResults results{.options = options, .environment = current_environment()};
  std::vector<Model> read;
  for (const std::string& name : options.models) {
    read.push_back(read_true_model(models, name));
    results.models.push_back(details_of(name, read.back()));
  }
  const std::filesystem::path file = folder / "paper.json";
  if (std::filesystem::exists(file)) {
    PaperResults there = read_paper_results(file);
    check_same_experiment(file, there, results);
    results.runs = std::move(there.runs);
  }
  const auto keep = [&] { write_text_file(file, to_json(results)); };
  // Written before the first run, so that a read-only folder fails at once.
  keep();
  run_paper(read, results, keep, run);
  return results;
}

}  // namespace cloud2csg
