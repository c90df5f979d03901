#include "raw_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "values.hpp"

namespace cloud2csg::app {
namespace {

/// What somebody knows of the part.
void add_knowledge_arguments(CLI::App& app, RawArguments& arguments, const std::string& group) {
  app.add_option("--radii", arguments.radii,
                 "Radii that spheres, cylinders and tori have, as in 2.5,3,6: each takes the nearest of them, unless "
                 "its points contradict")
      ->delimiter(',')
      ->check(number_positive())
      ->allow_extra_args(false)
      ->type_name("R,R...")
      ->group(group);
  app.add_option("--axes", arguments.axes,
                 "Directions that planes, cylinders, cones and tori have, as in x,y,z or x,1,1,0: each takes one that "
                 "is within 5 degrees, unless its points contradict")
      ->check(directions())
      ->allow_extra_args(false)
      ->type_name("A,A...")
      ->group(group);
  app.add_option("--min-size", arguments.min_size,
                 "Surfaces with a smaller radius, or whose points reach less far, are left out (default: none)")
      ->check(number_positive())
      ->type_name("D")
      ->group(group);
  app.add_option("--max-size", arguments.max_size, "... and those with a larger one, or that reach farther")
      ->check(number_positive())
      ->type_name("D")
      ->group(group);
}

}  // namespace

ReconstructOptions RawArguments::options(const ExtractOptions& extraction, const Input& input) const {
  ReconstructOptions options{.extraction = extraction};
  options.preparation.clean.remove_outliers = !keeps_outliers;
  options.preparation.clean.point_budget = point_budget;
  options.close_unseen = !leaves_open;
  options.preparation.keep_normals = !estimates_normals;
  // Points drawn from a mesh lie on it, and so do not have to be looked at.
  options.preparation.is_exact = input.mesh.has_value() && !estimates_normals;
  options.detection.distance_tolerance = tolerance;
  if (normal_tolerance_deg) options.detection.angle_tolerance_deg = *normal_tolerance_deg;
  options.detection.least_points = least_points;
  options.detection.seed = extraction.seed;
  options.solids.leaf_cost = leaf_cost;
  options.solids.places.seed = extraction.seed;
  options.detection.least_size = min_size;
  options.detection.most_size = max_size;
  options.solids.regularity.snap = !does_not_snap;
  options.solids.regularity.radii = radii;
  for (const std::string& list : axes) {
    const std::vector<Eigen::Vector3d> given = parse_directions(list).value();
    options.solids.regularity.axes.insert(options.solids.regularity.axes.end(), given.begin(), given.end());
  }
  return options;
}

InputOptions RawArguments::input(const ExtractOptions& extraction) const {
  return {.mesh_points = std::min(mesh_points, point_budget), .seed = extraction.seed};
}

void check_arguments(const RawArguments& arguments) {
  if (!arguments.min_size || !arguments.max_size || *arguments.min_size <= *arguments.max_size) return;
  throw CLI::ValidationError("--min-size", fmt::format("expected no more than --max-size, found {} and {}",
                                                       *arguments.min_size, *arguments.max_size));
}

void add_raw_arguments(CLI::App& app, RawArguments& arguments, const std::string& group) {
  app.add_option("--tolerance", arguments.tolerance,
                 "How far points may be from their surface, in the cloud's units (default: 3 x the measured noise, at "
                 "least 0.15 % of the diagonal)")
      ->check(number_positive())
      ->type_name("D")
      ->group(group);
  app.add_option("--normal-tolerance", arguments.normal_tolerance_deg,
                 "... and how far their normals may be turned from the surface's (default: 25)")
      ->check(number_positive())
      ->check(number_from_to(0, 90))
      ->type_name("DEG")
      ->group(group);
  app.add_option("--least-points", arguments.least_points,
                 "Surfaces with fewer are left alone (default: one in 2000, at least 30)")
      ->transform(whole_number_from(1))
      ->type_name("N")
      ->group(group);
  app.add_option("--leaf-cost", arguments.leaf_cost,
                 "What a solid must gain, as a share of the volume and surface: more gives smaller trees")
      ->check(number_positive())
      ->type_name("SHARE")
      ->group(group)
      ->capture_default_str();
  app.add_flag("--no-snap", arguments.does_not_snap,
               "Keep directions, offsets and radii as they were measured: nothing is made parallel or equal, but for "
               "what --radii and --axes say")
      ->group(group);
  add_knowledge_arguments(app, arguments, group);
  app.add_flag("--estimate-normals", arguments.estimates_normals, "Do not use the normals that the cloud has")
      ->group(group);
  app.add_flag("--keep-outliers", arguments.keeps_outliers, "Do not look for outliers: the cloud is clean")
      ->group(group);
  app.add_flag(
         "--leave-open", arguments.leaves_open,
         "Do not close a side without any points, as that on which a scanned part stood, by a plane, nor go on with "
         "walls of bores that no sensor saw")
      ->group(group);
  app.add_option("--point-budget", arguments.point_budget, "Larger clouds are thinned to about so many points")
      ->transform(whole_number_from(1000))
      ->type_name("N")
      ->group(group)
      ->capture_default_str();
  app.add_option("--mesh-points", arguments.mesh_points,
                 "How many points are drawn from a mesh; at most --point-budget")
      ->transform(whole_number_from(100))
      ->type_name("N")
      ->group(group)
      ->capture_default_str();
}

}  // namespace cloud2csg::app
