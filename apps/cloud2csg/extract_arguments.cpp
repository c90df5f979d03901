#include "extract_arguments.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "cloud2csg/error.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array k_strategies{Strategy::automatic, Strategy::cells, Strategy::partition, Strategy::baseline};
constexpr std::array k_precisions{Precision::automatic, Precision::full, Precision::single};
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
    add(option, value, "N", help)->transform(whole_number(0, std::numeric_limits<int>::max()));
  }
  void count(const std::string& option, std::optional<std::size_t>& value, const std::string& help) {
    add(option, value, "N", help)->transform(whole_number_from(0));
  }
  void number(const std::string& option, std::optional<double>& value, const std::string& help) {
    add(option, value, "X", help)->check(number_not_negative());
  }
  void fraction(const std::string& option, std::optional<double>& value, const std::string& help) {
    add(option, value, "SHARE", help)->check(share());
  }
  /// `--name` and `--no-name`, of which one may be given.
  void either(const std::string& name, std::optional<bool>& value, const std::string& help,
              const std::string& help_no) {
    CLI::Option* yes = app_.add_flag_callback(
        "--" + name, [&value] { value = true; }, help);
    CLI::Option* no = app_.add_flag_callback(
        "--no-" + name, [&value] { value = false; }, help_no);
    yes->group(name_);
    no->group(name_)->excludes(yes);
  }

 private:
  CLI::App& app_;
  std::string name_;
};

void add_search_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Search");
  group.add("--preset", arguments.preset, "NAME", "default, or paper: the paper's weights and search, nothing added")
      ->check(one_of({"default", "paper"}))
      ->capture_default_str();
  group
      .add("--strategy", arguments.strategy, "NAME",
           "auto, cells: space cut into cells, each in or out, partition: a tree per partition, merged, or baseline: "
           "all primitives at once (default: auto: cells, and partitions where the points do not bear them out)")
      ->check(one_of(names_of(k_strategies)));
  group.add("--parallel", arguments.parallel, "WHAT", "none, population, partitions or both (default: both)")
      ->check(one_of(names_of(k_parallels)));
  group.add("--seed", arguments.seed, "S", "Same seed, same tree, whatever the threads (default: 1)")
      ->transform(whole_number_from(0));
  group
      .add("--time-limit", arguments.time_limit_seconds, "SECONDS",
           "Then take the best tree so far; reading and writing are not counted (default: none)")
      ->check(number_not_negative());
  group.either("polish", arguments.polish, "Improve the merged trees by the whole cloud (default)",
               "Take them as they are (paper)");
  group.either("strangers", arguments.strangers,
               "Judge a partition's trees also by points inside primitives of others (paper)",
               "... without them: no tree of the partition explains them (default)");
}

void add_genetic_algorithm_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Genetic algorithm");
  group.count("--population", arguments.population, "Trees a generation (default: 150)");
  group.count("--elites", arguments.elites, "Best trees that are kept (default: 2)");
  group.count("--tournament", arguments.tournament, "A parent is the best of so many (default: 2)");
  group.fraction("--crossover-rate", arguments.crossover_rate, "Parents that swap subtrees (default: 0.3)");
  group.fraction("--mutation-rate", arguments.mutation_rate, "Children that are mutated (default: 0.3)");
  group.fraction("--new-tree-rate", arguments.new_tree_rate, "Mutations that replace the whole tree (default: 0.5)");
  group.count("--height-limit", arguments.height_limit, "Height of a tree (default: sqrt(pi/2 n (n-1)))");
  group.count("--idle-generations", arguments.idle_generations,
              "Stop after so many generations without a better tree (default: 40, paper: 10)");
  group.count("--generation-limit", arguments.generation_limit, "Stop after so many in any case (default: 10000)");
  group.count("--listing-limit", arguments.listing_limit,
              "Partitions up to this size are solved by listing, 0 to 5 (default: 4, paper: 2)");
  group.fraction("--trust", arguments.trust,
                 "A tree that reaches less than this share of the best score that can be is searched for again "
                 "(default: 0.97, paper: 0, never)");
  group.count("--restarts", arguments.restarts, "... so many times at most (default: 3, paper: 0)");
  group.count("--restart-budget", arguments.restart_budget,
              "... and not when so many trees were evaluated for a partition (default: 200000)");
  group.either("seeds", arguments.seeds, "The first generation also has results of local searches (default)",
               "The first generation is random (paper)");
  group.either("local-search", arguments.local_search, "Improve the best tree at the end by single changes (default)",
               "Take the best tree as it is (paper)");
}

void add_fit_arguments(CLI::App& app, ExtractArguments& arguments) {
  Group group(app, "Fit");
  group.number("--distance-tolerance", arguments.distance_tolerance,
               "Points nearer than this belong to a primitive (default: 3 x the measured noise)");
  group
      .add("--angle-tolerance", arguments.angle_tolerance_deg, "DEG",
           "... when their normal is within so many degrees (default: 30)")
      ->check(number_not_negative());
  group.number("--overlap-tolerance", arguments.overlap_tolerance,
               "Primitives nearer than this overlap (default: the measured noise)");
  group
      .add("--precision", arguments.precision, "NAME",
           "Of distances and angles: full, single, or auto: single where the noise is far above rounding (default: "
           "auto, "
           "paper: full)")
      ->check(one_of(names_of(k_precisions)));
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
  override_with(search.trust, arguments.trust);
  override_with(search.restarts, arguments.restarts);
  override_with(search.restart_budget, arguments.restart_budget);
  override_with(search.seeds, arguments.seeds);
  override_with(search.polish, arguments.local_search);
}

/// The option that sets a field of the library's options: "angle_tolerance_deg" is --angle-tolerance.
std::string option_of(std::string field) {
  for (const std::string_view unit : {"_deg", "_seconds"}) {
    if (field.ends_with(unit)) field.resize(field.size() - unit.size());
  }
  std::replace(field.begin(), field.end(), '_', '-');
  return "--" + field;
}

}  // namespace

ExtractOptions ExtractArguments::options() const {
  ExtractOptions options = preset == "paper" ? paper_options() : ExtractOptions{};
  override_by_name(k_strategies, options.strategy, strategy);
  override_by_name(k_parallels, options.parallel, parallel);
  override_by_name(k_precisions, options.precision, precision);
  override_with(options.seed, seed);
  override_with(options.time_limit_seconds, time_limit_seconds);
  override_with(options.polish, polish);
  if (strangers) options.without_strangers = !*strangers;
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

void check_arguments(const CLI::App& app, const ExtractArguments& arguments) {
  try {
    (void)arguments.options();
  } catch (const Error& error) {
    const std::string option = option_of(error.parts().where);
    throw CLI::ValidationError(app.get_option_no_throw(option) != nullptr ? option : error.parts().where,
                               error.parts().expected);
  }
}

void add_extract_arguments(CLI::App& app, ExtractArguments& arguments) {
  add_search_arguments(app, arguments);
  add_genetic_algorithm_arguments(app, arguments);
  add_fit_arguments(app, arguments);
}

}  // namespace cloud2csg::app
