#include "bindings.hpp"
#include "cloud2csg/extract.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "option_class.hpp"

namespace cloud2csg::python {
namespace {

void bind_judgement(py::module_& module) {
  OptionClass<SegmentationOptions>(module, "SegmentationOptions", "Which points lie on which primitive.")
      .field("distance_tolerance", &SegmentationOptions::distance_tolerance,
             "A point may belong to a primitive when it is nearer to its surface than this, in the cloud's units. "
             "None: three times the estimated noise.")
      .field("angle_tolerance_deg", &SegmentationOptions::angle_tolerance_deg,
             "... and its normal is within this angle of the surface's, whichever way round.")
      .finish();
  OptionClass<ObjectiveOptions>(module, "ObjectiveOptions", "Weights of the paper's objective E(t).")
      .field("alpha", &ObjectiveOptions::alpha, "Cost of a node, in points. None: ln of the points, as in the paper.")
      .field("beta", &ObjectiveOptions::beta, "Per unit of length. None: 1 / noise. The paper: 100.")
      .field("gamma", &ObjectiveOptions::gamma, "Per radian.")
      .finish();
  OptionClass<SampleCounts>(module, "SampleCounts", "How many samples of its surface a primitive gets.")
      .field("base", &SampleCounts::base, "Each.")
      .field("a_neighbour", &SampleCounts::a_neighbour, "So many for each other one whose bounds meet its own.")
      .field("most", &SampleCounts::most, "At most.")
      .finish();
  OptionClass<LabelOptions>(module, "LabelOptions", "What labels of cells cost.")
      .field("absence", &LabelOptions::absence,
             "Share of the points that the area of a surface lets expect, below which those missing cost.")
      .field("absence_in_scans", &LabelOptions::absence_in_scans,
             "The same, where it is less, for clouds that say where their sensors stood.")
      .field("presence", &LabelOptions::presence, "Points that a patch has stand for so many of those.")
      .field("sight", &LabelOptions::sight, "Cost of a line of sight through the solid, in points.")
      .finish();
  OptionClass<MinimalFormulaOptions>(module, "MinimalFormulaOptions", "How much work a minimal formula may take.")
      .field("table_limit", &MinimalFormulaOptions::table_limit, "Functions of few leaves that are listed.")
      .field("combination_limit", &MinimalFormulaOptions::combination_limit, "Pairs of such functions that are tried.")
      .finish();
  OptionClass<LocalSearchOptions>(module, "LocalSearchOptions", "Climbing by the best of all small changes of a tree.")
      .field("shrink_only", &LocalSearchOptions::shrink_only, "Only changes that make the tree smaller.")
      .field("evaluation_limit", &LocalSearchOptions::evaluation_limit, "Trees that are looked at, at most.")
      .field("work_limit", &LocalSearchOptions::work_limit, "Evaluations x classes x nodes, at most.")
      .finish();
  OptionClass<CellSolveOptions>(module, "CellSolveOptions", "From labelled cells to a small tree.")
      .field("least_evidence", &CellSolveOptions::least_evidence,
             "Of cells whose labels cost fewer points to change, the formula may make what it likes. Descending; each "
             "is tried.")
      .field("leaf_cost", &CellSolveOptions::leaf_cost, "Of a leaf, in points.")
      .nested("minimal", &CellSolveOptions::minimal, "The search for a minimal formula, core by core.")
      .nested("climb", &CellSolveOptions::climb,
              "The local searches where the formula is not proved to be minimal. No work, no climbing.")
      .finish();
}

void bind_search(py::module_& module) {
  OptionClass<GaOptions>(module, "GaOptions", "The search for the tree of one partition.")
      .field("population", &GaOptions::population, "Trees a generation.")
      .field("elites", &GaOptions::elites, "Best trees that go to the next generation unchanged.")
      .field("tournament", &GaOptions::tournament, "A parent is the best of so many drawn at random.")
      .field("crossover_rate", &GaOptions::crossover_rate, "Chance that two parents swap random subtrees.")
      .field("mutation_rate", &GaOptions::mutation_rate, "Chance that a child is mutated.")
      .field("new_tree_rate", &GaOptions::new_tree_rate, "Of the mutations: the whole tree is replaced by a new one.")
      .field("height_limit", &GaOptions::height_limit,
             "Edges on the longest path of a tree. None: sqrt(pi / 2 * n (n - 1)) for n primitives.")
      .field("idle_generations", &GaOptions::idle_generations,
             "Stop when the best score has not improved for so many generations.")
      .field("generation_limit", &GaOptions::generation_limit, "Stop here in any case.")
      .field("listing_limit", &GaOptions::listing_limit,
             "Partitions of up to so many primitives are solved by listing; at most 5.")
      .field("trust", &GaOptions::trust, "A tree is believed at this share of what no tree can exceed.")
      .field("restarts", &GaOptions::restarts, "New runs, at most, while the best tree is not believed.")
      .field("restart_budget", &GaOptions::restart_budget, "... and no more than so many trees were evaluated.")
      .field("seeds", &GaOptions::seeds, "The first generation also has results of local searches.")
      .field("polish", &GaOptions::polish, "A local search on the best tree at the end.")
      .field("seed", &GaOptions::seed, "Not used within ExtractOptions, which has one of its own.")
      .finish();
}

void bind_extraction(py::module_& module) {
  OptionClass<ExtractOptions>(module, "ExtractOptions", "From a cloud and known primitives to a tree: see extract().")
      .choice("strategy", &ExtractOptions::strategy,
              {{"auto", Strategy::automatic},
               {"cells", Strategy::cells},
               {"partition", Strategy::partition},
               {"baseline", Strategy::baseline}},
              "'auto': by cells where the points bear that out, else partitions. 'partition': the paper's. 'baseline': "
              "all primitives in one genetic algorithm.")
      .choice("parallel", &ExtractOptions::parallel,
              {{"none", Parallel::none},
               {"population", Parallel::population},
               {"partitions", Parallel::partitions},
               {"both", Parallel::both}},
              "What runs in parallel in the search. The result is the same for each.")
      .nested("segmentation", &ExtractOptions::segmentation, "Which points lie on which primitive.")
      .nested("objective", &ExtractOptions::objective, "Weights of the objective.")
      .choice("precision", &ExtractOptions::precision,
              {{"auto", Precision::automatic}, {"full", Precision::full}, {"single", Precision::single}},
              "Of distances and angles in the pass over the points.")
      .nested("search", &ExtractOptions::search, "The genetic algorithm.")
      .field("cell_trust", &ExtractOptions::cell_trust,
             "Take the tree of the cells where the points contradict at most what is missing here to 1.")
      .nested("cell_samples", &ExtractOptions::cell_samples, "Samples of surfaces, to find cells without points.")
      .nested("cell_labels", &ExtractOptions::cell_labels, "What labels of cells cost.")
      .nested("cell_solve", &ExtractOptions::cell_solve, "From cells to the tree.")
      .field("overlap_tolerance", &ExtractOptions::overlap_tolerance,
             "Solids nearer than this overlap, in the cloud's units. None: the measured noise.")
      .field("without_strangers", &ExtractOptions::without_strangers,
             "Judge the trees of a partition without the points inside primitives of others.")
      .field("polish", &ExtractOptions::polish, "Improve merged trees by the whole cloud.")
      .field("time_limit_seconds", &ExtractOptions::time_limit_seconds,
             "Stop the search after so many seconds, with the best tree so far.")
      .field("seed", &ExtractOptions::seed, "The same seed gives the same tree, for any number of threads.")
      .finish()
      .def_static("paper", &paper_options, "As in the paper: its weights, its genetic algorithm, no polish.");
  OptionClass<RefineOptions>(module, "RefineOptions", "Primitives moved to where the points are: see extract().")
      .field("noise", &RefineOptions::noise,
             "Standard deviation of the points from the true surface, in the cloud's units. None: measured.")
      .field("angle_tolerance_deg", &RefineOptions::angle_tolerance_deg,
             "A point tells of a primitive when its normal is within this angle of the surface's.")
      .field("rounds", &RefineOptions::rounds, "Times that the points are dealt out to the primitives anew.")
      .field("most_points", &RefineOptions::most_points, "Of a primitive's points, this many are taken.")
      .field("regularise", &RefineOptions::regularise, "Take what is nearly regular for regular.")
      .field("regularity_angle_deg", &RefineOptions::regularity_angle_deg,
             "Directions within this angle of being parallel or orthogonal are made so.")
      .finish();
}

void bind_detecting(py::module_& module) {
  OptionClass<DetectOptions>(module, "DetectOptions", "How surfaces are detected: see detect().")
      .field("distance_tolerance", &DetectOptions::distance_tolerance,
             "How far a point may be from its surface, in the cloud's units. None: three times the noise, and at least "
             "0.15 % of the cloud's diagonal.")
      .field("angle_tolerance_deg", &DetectOptions::angle_tolerance_deg,
             "... and how far its normal may be turned from the surface's.")
      .field("least_points", &DetectOptions::least_points,
             "Surfaces with fewer points are left alone. None: one in 2000 of the cloud's, and at least 30.")
      .field("least_size", &DetectOptions::least_size,
             "The least radius of a surface, and diagonal of its points, in the cloud's units. None: no limit.")
      .field("most_size", &DetectOptions::most_size, "... and the most. None: no limit.")
      .field("seed", &DetectOptions::seed, "The same seed gives the same surfaces, for any number of threads.")
      .finish();
  OptionClass<PlaceOptions>(module, "PlaceOptions", "Places by which solids are judged.")
      .field("noise", &PlaceOptions::noise,
             "Standard deviation of the points from the surface, in the cloud's units. None: a tenth of the spacing.")
      .field("volume_places", &PlaceOptions::volume_places, "Spread over the cloud's bounds, grown by `margin`.")
      .field("surface_points", &PlaceOptions::surface_points, "Points that have a place on either side, at most.")
      .field("margin", &PlaceOptions::margin, "Share of the diagonal.")
      .field("seed", &PlaceOptions::seed, "Of the places.")
      .finish();
}

void bind_choosing(py::module_& module) {
  OptionClass<RegularityOptions>(module, "RegularityOptions", "What of the surfaces is made regular.")
      .field("snap", &RegularityOptions::snap,
             "False: surfaces are not made like each other. What is given holds all the same.")
      .field("angle_tolerance_deg", &RegularityOptions::angle_tolerance_deg,
             "Directions nearer than this to each other, or to an orthogonal one, are made so.")
      .field("distance_tolerance", &RegularityOptions::distance_tolerance,
             "Offsets, centres and radii nearer than this are made equal, in the cloud's units. None: twice the noise, "
             "at least 1e-3 of the diagonal.")
      .field(
          "radii", &RegularityOptions::radii,
          "Radii that spheres, cylinders and tori are known to have: each takes the nearest that its points bear out.")
      .vectors("axes", &RegularityOptions::axes,
               "Directions that planes, cylinders, cones and tori are known to have, of any length, either way round.")
      .field("axis_tolerance_deg", &RegularityOptions::axis_tolerance_deg,
             "Surfaces nearer than this to a given direction take it.")
      .field("given_tolerance", &RegularityOptions::given_tolerance,
             "How much farther the points may be from a surface with given values, in the cloud's units. None: the "
             "tolerance of the detection.")
      .finish();
  OptionClass<SolidOptions>(module, "SolidOptions", "How solids are chosen that the surfaces bound.")
      .field("leaf_cost", &SolidOptions::leaf_cost, "What a leaf more must gain, as a share of volume and surface.")
      .field("plane_cost", &SolidOptions::plane_cost, "Of a plane of a polytope beyond the sixth, in leaves.")
      .field("most_rules", &SolidOptions::most_rules, "Of the decision list; a guard.")
      .nested("places", &SolidOptions::places, "Places by which solids are judged.")
      .field("volume_places_a_surface", &SolidOptions::volume_places_a_surface,
             "Places in the volume for each surface, where that is more than `places` has.")
      .field("surface_points_a_surface", &SolidOptions::surface_points_a_surface,
             "Points with places beside them for each surface, where that is more.")
      .nested("regularity", &SolidOptions::regularity, "What of the surfaces is made regular.")
      .finish();
  OptionClass<ReconstructOptions>(module, "ReconstructOptions", "From a raw cloud to a tree: see extract().")
      .field(
          "known", &ReconstructOptions::known,
          "Primitives that are known, which are kept as they are: only what the points show beyond them is detected.")
      .nested("preparation", &ReconstructOptions::preparation, "The cloud is cleaned and oriented.")
      .nested("detection", &ReconstructOptions::detection, "Surfaces are detected.")
      .field("close_unseen", &ReconstructOptions::close_unseen,
             "Close a side that is missing as a whole, as that on which the part stood, by a plane, and go on with the "
             "walls "
             "of bores where no sensor could see them.")
      .nested("solids", &ReconstructOptions::solids, "Solids are chosen.")
      .nested("extraction", &ReconstructOptions::extraction, "A tree over them is extracted.")
      .field("refine", &ReconstructOptions::refine,
             "RefineOptions: then move and size the solids to where the points are, where that is better.")
      .finish();
}

}  // namespace

void bind_extract_options(py::module_& module) {
  bind_judgement(module);
  bind_search(module);
  bind_extraction(module);
  bind_detecting(module);
  bind_choosing(module);
}

}  // namespace cloud2csg::python
