#include "bench/experiment/json_parts.hpp"
#include "bench/experiment/scaling.hpp"

namespace cloud2csg {
namespace {

constexpr ResultsFormat k_format{.name = "cloud2csg-scaling",
                                 .version = 1,
                                 .what = "results of the scaling experiment",
                                 .remedy = "give the scaling.json that 'cloud2csg bench scaling' wrote"};

Json run_json(const ScalingRun& run) {
  const ScalingCase& one = run.scaling_case;
  return {{"family", to_string(one.family)},
          {"clique_size", one.clique_size},
          {"primitives", one.primitives},
          {"points", one.points},
          {"threads", one.threads},
          {"seed", run.seed},
          {"finished", run.finished},
          {"complete", run.complete},
          {"partitions", run.partitions},
          {"components", run.components},
          {"seconds", stages_json(run.seconds)},
          {"tree", tree_json(run.tree)},
          {"true_tree", tree_json(run.true_tree)},
          {"fingerprint", run.fingerprint},
          {"generations", run.generations},
          {"evaluations", run.evaluations},
          {"peak_bytes", run.peak_bytes},
          {"cloud_bytes", run.cloud_bytes},
          {"wrong_share", run.wrong_share},
          {"wrong_primitives", run.wrong_primitives}};
}

ScalingRun run_from(const Json& json) {
  return {.scaling_case = {.family = family_of(json.at("family").get<std::string>()),
                           .clique_size = json.at("clique_size"),
                           .primitives = json.at("primitives"),
                           .points = json.at("points"),
                           .threads = json.at("threads")},
          .seed = json.at("seed"),
          .finished = json.at("finished"),
          .complete = json.at("complete"),
          .partitions = json.at("partitions"),
          .components = json.at("components"),
          .seconds = stages_from(json.at("seconds")),
          .tree = tree_from(json.at("tree")),
          .true_tree = tree_from(json.at("true_tree")),
          .fingerprint = json.at("fingerprint"),
          .generations = json.at("generations"),
          .evaluations = json.at("evaluations"),
          .peak_bytes = json.at("peak_bytes"),
          .cloud_bytes = json.at("cloud_bytes"),
          .wrong_share = json.at("wrong_share"),
          .wrong_primitives = json.at("wrong_primitives")};
}

ScalingResults results_from(const Json& json) {
  ScalingResults results{.options = options_from<ScalingOptions>(json.at("options")),
                         .environment = environment_from(json.at("environment"))};
  for (const Json& run : json.at("runs")) results.runs.push_back(run_from(run));
  return results;
}

}  // namespace

std::string to_json(const ScalingResults& results) {
  Json runs = Json::array();
  for (const ScalingRun& run : results.runs) runs.push_back(run_json(run));
  const Json json = {{"format", k_format.name},
                     {"format_version", k_format.version},
                     {"options", options_json(results.options)},
                     {"environment", environment_json(results.environment)},
                     {"runs", std::move(runs)}};
  return json.dump(1) + "\n";
}

ScalingResults read_scaling_results(const std::filesystem::path& file) {
  return read_results(file, k_format, results_from);
}

}  // namespace cloud2csg
