#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/experiment.hpp"

namespace cloud2csg {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view k_format = "cloud2csg-paper";
constexpr int k_version = 1;

/// Names and fields of what an extraction is measured in; those of the command line are not.
template <typename Seconds, typename Visit>
void visit_stages(Seconds& s, const Visit& visit) {
  visit("segment", s.segment);
  visit("overlap", s.overlap);
  visit("partition", s.partition);
  visit("classes", s.classes);
  visit("search", s.search);
  visit("merge", s.merge);
  visit("simplify", s.simplify);
  visit("extraction", s.extraction);
}

Json tree_json(const TreeStatistics& tree) {
  return {{"size", tree.size}, {"leaves", tree.leaves}, {"depth", tree.depth}};
}

TreeStatistics tree_from(const Json& json) {
  return {.size = json.at("size"), .leaves = json.at("leaves"), .depth = json.at("depth")};
}

Json options_json(const PaperOptions& o) {
  return {{"models", o.models}, {"low_points", o.low_points}, {"high_points", o.high_points},
          {"noise", o.noise},   {"repeats", o.repeats},       {"seed", o.seed},
          {"preset", o.preset}, {"evaluator", o.evaluator},   {"threads", o.threads}};
}

PaperOptions options_from(const Json& json) {
  return {.models = json.at("models"),
          .low_points = json.at("low_points"),
          .high_points = json.at("high_points"),
          .noise = json.at("noise"),
          .repeats = json.at("repeats"),
          .seed = json.at("seed"),
          .preset = json.at("preset"),
          .evaluator = json.at("evaluator"),
          .threads = json.at("threads")};
}

Json environment_json(const Environment& e) {
  return {{"version", e.version}, {"compiler", e.compiler}, {"cpu", e.cpu}, {"cores", e.cores}};
}

Environment environment_from(const Json& json) {
  return {
      .version = json.at("version"), .compiler = json.at("compiler"), .cpu = json.at("cpu"), .cores = json.at("cores")};
}

Json run_json(const PaperRun& run) {
  Json seconds;
  visit_stages(run.seconds, [&seconds](const char* name, double value) { seconds[name] = value; });
  return {{"model", run.name.model},
          {"sampling", to_string(run.name.sampling)},
          {"mode", run.name.mode},
          {"seed", run.name.seed},
          {"finished", run.finished},
          {"points", run.points},
          {"clique_histogram", run.clique_histogram},
          {"seconds", std::move(seconds)},
          {"generations", run.generations},
          {"evaluations", run.evaluations},
          {"merge_ways", run.merge_ways},
          {"blocked", run.blocked},
          {"tree", tree_json(run.tree)},
          {"fit",
           {{"objective", run.fit.objective},
            {"rms_distance", run.fit.rms_distance},
            {"p95_distance", run.fit.p95_distance},
            {"rms_angle_deg", run.fit.rms_angle_deg}}},
          {"formula", run.formula}};
}

PaperRun run_from(const Json& json) {
  const Json& fit = json.at("fit");
  PaperRun run{.name = {.model = json.at("model"),
                        .sampling = json.at("sampling") == to_string(Sampling::low) ? Sampling::low : Sampling::high,
                        .mode = json.at("mode"),
                        .seed = json.at("seed")},
               .finished = json.at("finished"),
               .points = json.at("points"),
               .clique_histogram = json.at("clique_histogram"),
               .tree = tree_from(json.at("tree")),
               .formula = json.at("formula"),
               .fit = {.objective = fit.at("objective"),
                       .rms_distance = fit.at("rms_distance"),
                       .p95_distance = fit.at("p95_distance"),
                       .rms_angle_deg = fit.at("rms_angle_deg")},
               .generations = json.at("generations"),
               .evaluations = json.at("evaluations"),
               .merge_ways = json.at("merge_ways"),
               .blocked = json.at("blocked")};
  visit_stages(run.seconds, [&json](const char* name, double& value) { value = json.at("seconds").at(name); });
  return run;
}

PaperResults results_from(const Json& json) {
  PaperResults results{.options = options_from(json.at("options")),
                       .environment = environment_from(json.at("environment"))};
  for (const Json& model : json.at("models")) {
    results.models.push_back({.name = model.at("name"),
                              .primitives = model.at("primitives"),
                              .tree = tree_from(model.at("tree")),
                              .fingerprint = model.at("fingerprint")});
  }
  for (const Json& run : json.at("runs")) results.runs.push_back(run_from(run));
  return results;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& expected) {
  throw Error({.file = file.string(),
               .where = {},
               .expected = expected,
               .remedy = "give the paper.json that 'cloud2csg bench paper' wrote"});
}

}  // namespace

std::string to_json(const PaperResults& results) {
  Json models = Json::array();
  for (const ModelDetails& model : results.models) {
    models.push_back({{"name", model.name},
                      {"primitives", model.primitives},
                      {"tree", tree_json(model.tree)},
                      {"fingerprint", model.fingerprint}});
  }
  Json runs = Json::array();
  for (const PaperRun& run : results.runs) runs.push_back(run_json(run));
  const Json json = {{"format", k_format},
                     {"format_version", k_version},
                     {"options", options_json(results.options)},
                     {"environment", environment_json(results.environment)},
                     {"models", std::move(models)},
                     {"runs", std::move(runs)}};
  return json.dump(1) + "\n";
}

PaperResults read_paper_results(const std::filesystem::path& file) {
  const Json json = Json::parse(read_text_file(file), nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) refuse(file, "it is not JSON");
  if (!json.is_object() || json.value("format", Json()) != k_format ||
      json.value("format_version", Json()) != k_version) {
    refuse(file, "it holds no results of the paper's experiment");
  }
  try {
    return results_from(json);
  } catch (const Json::exception& error) {
    refuse(file, std::string("a field is missing or of the wrong type: ") + error.what());
  }
}

}  // namespace cloud2csg
