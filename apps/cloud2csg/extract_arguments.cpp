#include "extract_arguments.hpp"

#include <array>
#include <string_view>
#include <vector>

#include "command.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array k_strategies{Strategy::automatic, Strategy::partition, Strategy::baseline};
constexpr std::array k_parallels{Parallel::none, Parallel::population, Parallel::partitions, Parallel::both};

template <typename Value, typename Given>
void override_with(Value& value, const std::optional<Given>& given) {
  if (given) value = *given;
}

template <typename Choices, typename Choice>
void override_by_name(const Choices& choices, Choice& value, const std::optional<std::string>& given) {
  for (const Choice choice : choices) {
    if (given && to_string(choice) == *given) value = choice;
  }
}

template <typename Choices>
std::vector<std::string> names_of(const Choices& choices) {
  std::vector<std::string> names;
  names.reserve(choices.size());
  for (const auto choice : choices) names.emplace_back(to_string(choice));
  return names;
}

/// The options of one group of the help.
class Group {
 public:
  Group(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}

  template <typename Value>
  CLI::Option* add(const std::string& option, Value& value, const std::string& type, const std::string& help) {
    return app_.add_option(option, value, help)->type_name(type)->group(name_);
  }
  void count(const std::string& option, std::optional<int>& value, const std::string& help) {
    add(option, value, "N", help)->check(CLI::NonNegativeNumber);
  }
  void number(const std::string& option, std::optional<double>& value, const std::string& help) {
    add(option, value, "X", help)->check(finite_not_negative());
  }
  void share(const std::string& option, std::optional<double>& value, const std::string& help) {
    add(option, value, "SHARE", help)->check(CLI::Range(0.0, 1.0));
  }

 private:
  CLI::App& app_;
  std::string name_;
};

void add_search_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Search");
  group.add("--preset", arguments.preset, "NAME", "default, or paper: the paper's weights and search, nothing added")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  group
      .add("--strategy", arguments.strategy, "NAME",
           "auto, partition: a tree per partition, merged, or baseline: all primitives at once (default: auto)")
      ->check(CLI::IsMember(names_of(k_strategies)));
  group.add("--parallel", arguments.parallel, "WHAT", "none, population, partitions or both (default: both)")
      ->check(CLI::IsMember(names_of(k_parallels)));
  group.add("--seed", arguments.seed, "S", "Same seed, same tree, whatever the threads (default: 1)");
  group.add("--time-limit", arguments.time_limit_seconds, "SECONDS", "Then take the best tree so far (default: none)")
      ->check(finite_not_negative());
  app.add_flag("--no-polish", arguments.no_polish,
               "Leave nodes in that the whole cloud does not need (as the paper does)")
      ->group("Search");
}

void add_genetic_algorithm_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Genetic algorithm");
  group.count("--population", arguments.population, "Trees a generation (default: 150)");
  group.count("--elites", arguments.elites, "Best trees that are kept (default: 2)");
  group.count("--tournament", arguments.tournament, "A parent is the best of so many (default: 2)");
  group.share("--crossover-rate", arguments.crossover_rate, "Parents that swap subtrees (default: 0.3)");
  group.share("--mutation-rate", arguments.mutation_rate, "Children that are mutated (default: 0.3)");
  group.share("--new-tree-rate", arguments.new_tree_rate, "Mutations that replace the whole tree (default: 0.5)");
  group.count("--height-limit", arguments.height_limit, "Height of a tree (default: sqrt(pi/2 n (n-1)))");
  group.count("--idle-generations", arguments.idle_generations,
              "Stop after so many generations without a better tree (default: 40, paper: 10)");
  group.count("--generation-limit", arguments.generation_limit, "Stop after so many in any case (default: 10000)");
  group
      .add("--listing-limit", arguments.listing_limit, "N",
           "Partitions up to this size are solved by listing, 0 to 5 (default: 4, paper: 2)")
      ->check(CLI::Range(0, 5));
}

void add_fit_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Fit");
  group.number("--distance-tolerance", arguments.distance_tolerance,
               "Points nearer than this belong to a primitive (default: 3 x the measured noise)");
  group.number("--angle-tolerance", arguments.angle_tolerance_deg,
               "... when their normal is within so many degrees (default: 30)");
  group.number("--overlap-tolerance", arguments.overlap_tolerance,
               "Primitives nearer than this overlap (default: the measured noise)");
  group.number("--alpha", arguments.alpha, "Cost of a node, in points (default: ln of the points)");
  group.number("--beta", arguments.beta, "Weight of distances (default: 1 / noise, paper: 100)");
  group.number("--gamma", arguments.gamma, "Weight of angles, per radian (default: 18 / pi)");
}

void override_search(GaOptions& search, const ExtractArguments& arguments) {
  override_with(search.population, arguments.population);
  override_with(search.elites, arguments.elites);
  override_with(search.tournament, arguments.tournament);
  override_with(search.crossover_rate, arguments.crossover_rate);
  override_with(search.mutation_rate, arguments.mutation_rate);
  override_with(search.new_tree_rate, arguments.new_tree_rate);
  override_with(search.height_limit, arguments.height_limit);
  override_with(search.idle_generations, arguments.idle_generations);
  override_with(search.generation_limit, arguments.generation_limit);
  override_with(search.listing_limit, arguments.listing_limit);
}

}  // namespace

ExtractOptions ExtractArguments::options() const {
  ExtractOptions options = preset == "paper" ? paper_options() : ExtractOptions{};
  override_by_name(k_strategies, options.strategy, strategy);
  override_by_name(k_parallels, options.parallel, parallel);
  override_with(options.seed, seed);
  override_with(options.time_limit_seconds, time_limit_seconds);
  if (no_polish) options.polish = false;
  override_search(options.search, *this);
  override_with(options.objective.alpha, alpha);
  override_with(options.objective.beta, beta);
  override_with(options.objective.gamma, gamma);
  override_with(options.segmentation.distance_tolerance, distance_tolerance);
  override_with(options.segmentation.angle_tolerance_deg, angle_tolerance_deg);
  override_with(options.overlap_tolerance, overlap_tolerance);
  validate(options);
  return options;
}

void add_extract_arguments(CLI::App& app, ExtractArguments& arguments) {
  add_search_arguments(app, arguments);
  add_genetic_algorithm_arguments(app, arguments);
  add_fit_arguments(app, arguments);
}

}  // namespace cloud2csg::app
