#include "bench/experiment/json_parts.hpp"
#include "bench/experiment/paper.hpp"

namespace cloud2csg {
namespace {

constexpr ResultsFormat k_format{.name = "cloud2csg-paper",
                                 .version = 1,
                                 .what = "results of the paper's experiment",
                                 .remedy = "give the paper.json that 'cloud2csg bench paper' wrote"};

Json run_json(const PaperRun& run) {
  return {{"model", run.name.model},
          {"sampling", to_string(run.name.sampling)},
          {"mode", run.name.mode},
          {"seed", run.name.seed},
          {"finished", run.finished},
          {"points", run.points},
          {"clique_histogram", run.clique_histogram},
          {"seconds", stages_json(run.seconds)},
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
  return {.name = {.model = json.at("model"),
                   .sampling = json.at("sampling") == to_string(Sampling::low) ? Sampling::low : Sampling::high,
                   .mode = json.at("mode"),
                   .seed = json.at("seed")},
          .finished = json.at("finished"),
          .points = json.at("points"),
          .clique_histogram = json.at("clique_histogram"),
          .seconds = stages_from(json.at("seconds")),
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
}

PaperResults results_from(const Json& json) {
  PaperResults results{.options = options_from<PaperOptions>(json.at("options")),
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
  const Json json = {{"format", k_format.name},
                     {"format_version", k_format.version},
                     {"options", options_json(results.options)},
                     {"environment", environment_json(results.environment)},
                     {"models", std::move(models)},
                     {"runs", std::move(runs)}};
  return json.dump(1) + "\n";
}

PaperResults read_paper_results(const std::filesystem::path& file) {
  return read_results(file, k_format, results_from);
}

}  // namespace cloud2csg
