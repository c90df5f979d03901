#pragma once

#include <cstdint>
#include <optional>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Clouds from known shapes: points on a surface, and a simulated range scanner.
namespace cloud2csg {

struct SampleOptions {
  std::size_t count = 10'000;
  double density = 0, noise = 0, normal_noise_deg = 0;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<SampleOptions>, auto&& field) {
  using O = SampleOptions;
  field(&O::count, "count", "Number of points, unless a density is given", {.letter = 'n'});
  field(&O::density, "density", "Points per unit of area, for models only; 0: use `count`", at_least(0));
  field(&O::noise, "noise",
        "Standard deviation of the noise added to each coordinate, in the model's units. The paper uses 0.01.",
        at_least(0), {.unit = "SIGMA"});
  field(&O::normal_noise_deg, "normal_noise_deg",
        "Standard deviation of the tilt of normals, in degrees; for models only", at_least(0), {.unit = "DEG"});
  field(&O::seed, k_seed);
}
/// Refuses options with neither a count nor a density.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const SampleOptions& options);

/// Draws points uniformly by area from the solid's surface, with the outward normals of their places before the noise.
/// @throws Error when the solid is empty or unbounded; Cancelled.
[[nodiscard]] PointCloud sample_surface(const Model& model, const SampleOptions& options = {},
                                        const RunContext& run = {});

/// Moves each coordinate by a Gaussian of this sigma, in the cloud's units; normals stay. Deterministic. O(n)
[[nodiscard]] PointCloud with_noise(PointCloud cloud, double sigma, std::uint64_t seed = 1);

/// A range scanner that views a part from several places. Lengths are shares of the diagonal of the part's bounds
/// unless stated otherwise; the part's bounding sphere has half that diagonal as radius. The defaults are those of a
/// fair hand-held scanner on a part that reflects well. option_table() describes the fields.
struct ScanOptions {
  std::size_t views = 20;
  bool on_table = false;
  double distance = 3.0, field_of_view_deg = 0;
  std::size_t count = 100'000;
  double angular_step_deg = 0;
  double noise = 0.0005, quantisation = 0.0001;
  double grazing_angle_deg = 70, grazing_loss = 0.9;
  double outliers = 0.002, mixed_pixels = 0.5;
  double rotation_deg = 0.02, translation = 0.0003;
  bool with_normals = false;
  MeshingOptions meshing = {};
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<ScanOptions>, auto&& field) {
  using O = ScanOptions;
  field(&O::views, "views", "Number of sensors, spread evenly over a sphere around the part, which the seed rotates",
        from_to(1, 1e6));
  field(
      &O::on_table, "on_table",
      "The part lies on a table with its z axis upright: no sensor is below its middle, and its underside is not seen");
  field(&O::distance, "distance",
        "Distance of each sensor from the middle of the part, in radii of its bounding sphere", from_to(1.001, 1e6),
        {.unit = "R"});
  field(&O::field_of_view_deg, "field_of_view_deg",
        "Width and height of a view in degrees; 0: just the bounding sphere", from_to(0, 170), {.unit = "DEG"});
  field(&O::count, "count", "Number of points in all, unless the angle between rays is given", {.letter = 'n'});
  field(&O::angular_step_deg, "angular_step_deg",
        "Angle between neighbouring rays of a view in degrees; 0: the angle that gives `count` points", from_to(0, 170),
        {.unit = "DEG"});
  field(&O::noise, "noise",
        "Standard deviation of ranges, as a share of the bounds' diagonal; it grows with the range squared and with "
        "grazing incidence. Applies to a ray that hits perpendicularly at the distance of the middle; it grows with 1 "
        "/ cosine of the angle of incidence, up to twenty times.",
        at_least(0), {.unit = "SHARE", .group = "Defects"});
  field(&O::quantisation, "quantisation",
        "Step to which ranges are rounded, as a share of the diagonal; 0: no rounding", at_least(0),
        {.unit = "SHARE", .group = "Defects"});
  field(&O::grazing_angle_deg, "grazing_angle_deg",
        "Angle of incidence above which returns may be missing; 0: perpendicular to the surface, 90: along the surface",
        from_to(0, 89.999), {.unit = "DEG", .group = "Defects"});
  field(
      &O::grazing_loss, "grazing_loss",
      "Probability at 90 degrees of incidence that a return is missing; it grows linearly from 0 at the grazing angle",
      k_share, {.unit = "P", .group = "Defects"});
  field(&O::outliers, "outliers", "Probability that a return lies anywhere on its ray within the bounding sphere",
        k_share, {.unit = "P", .group = "Defects"});
  field(&O::mixed_pixels, "mixed_pixels",
        "Probability that a ray at an edge returns from between two surfaces. The ray is half an angular step wide: it "
        "grazes the edge of one surface and sees the other.",
        k_share, {.unit = "P", .group = "Defects"});
  field(&O::rotation_deg, "rotation_deg",
        "Standard deviation of the rotation error of each view, in degrees. About a random axis through the middle of "
        "the part.",
        at_least(0), {.unit = "DEG", .group = "Defects"});
  field(&O::translation, "translation",
        "Standard deviation of the shift error of each view, per coordinate, as a share of the diagonal", at_least(0),
        {.unit = "SHARE", .group = "Defects"});
  field(&O::with_normals, "with_normals", "Add the true outward normals, which no real scanner knows",
        {.option = "normals"});
  field(&O::meshing, "meshing", "Models: the mesh on which the first hit of each ray is found");
  field(&O::seed, k_seed);
}
/// Refuses options with neither a count nor an angular step.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const ScanOptions& options);

/// The same scanner without noise, quantisation, missing returns, outliers, mixed pixels and misregistration.
[[nodiscard]] ScanOptions without_defects(ScanOptions options);

/// Simulated scans of a mesh: the first hit of each ray, on either side of a triangle, with the defects of the options.
/// Sensor positions share the misregistration of their view. Points come view by view, row by row. The result does not
/// depend on the number of threads. (Rays that hit within rounding of an edge may take either of its triangles on other
/// instruction sets.) O(triangles log triangles + rays log triangles).
/// @throws Error naming the option that is out of range, or when there is nothing to see; Cancelled.
[[nodiscard]] PointCloud scan_mesh(const TriangleMesh& mesh, const ScanOptions& options = {},
                                   const RunContext& run = {});

/// The same for a model. A ray's hit on its mesh is moved onto the solid's surface. May miss parts thinner than some
/// cells.
/// @throws Error as scan_mesh(), and when the solid is empty or unbounded; Cancelled.
[[nodiscard]] PointCloud scan_model(const Model& model, const ScanOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
