#pragma once

#include <cstdint>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Clouds from known shapes: points on a surface, and a range scanner around it.
namespace cloud2csg {

struct SampleOptions {
  std::size_t count = 10'000;   ///< points to make; used when density is 0
  double density = 0.0;         ///< points per unit of area; 0 = use count
  double noise = 0.0;           ///< sigma of the Gaussian displacement of each coordinate (the paper: 0.01)
  double normal_noise_deg = 0;  ///< sigma of the angle by which normals are tilted
  std::uint64_t seed = 1;
};

/// Points on a model's surface: uniform by area, only where the primitives' surfaces are the surface of the whole
/// solid, with outward normals. Positions are moved by the noise after the normal was taken.
/// @throws Error when the solid is empty or unbounded; Cancelled.
[[nodiscard]] PointCloud sample_surface(const CsgTree& tree, const PrimitiveSet& primitives,
                                        const SampleOptions& options = {}, const RunContext& run = {});

/// Moves each coordinate by a Gaussian of this sigma, in the cloud's units; normals stay. The same seed moves the same
/// way. O(n)
[[nodiscard]] PointCloud with_noise(PointCloud cloud, double sigma, std::uint64_t seed = 1);

/// A range scanner that is put around a part, view by view. Lengths are shares of the diagonal of the part's bounds
/// where nothing else is said; the part's bounding sphere has half that diagonal as radius. The defaults are those of a
/// fair hand-held scanner on a part that reflects well.
struct ScanOptions {
  std::size_t views = 20;  ///< sensors, spread evenly over a sphere around the part (Fibonacci), turned by the seed
  /// The part lies on a table, its z axis upright: sensors are above its middle only, and nothing is seen of the side
  /// on which it lies.
  bool on_table = false;
  double distance = 3.0;         ///< from the middle of the part to each sensor, in bounding radii; more than 1
  double field_of_view_deg = 0;  ///< width and height of what a view sees, up to 170; 0 = just the bounding sphere
  std::size_t count = 100'000;   ///< points in all; used when angular_step_deg is 0
  double angular_step_deg = 0;   ///< between neighbouring rays of a view; 0 = what gives `count` points

  /// Sigma of the error along the ray, at the middle's distance and where the ray hits the surface squarely. It grows
  /// with the square of the range and with 1 / cosine of the incidence, up to twenty times.
  double noise = 0.0005;
  double quantisation = 0.0001;  ///< the range is a multiple of this; 0 = any number
  /// From this incidence on (0 = squarely, 90 = along the surface) returns are missing, with a probability that grows
  /// evenly up to `grazing_loss` at 90 degrees.
  double grazing_angle_deg = 70;
  double grazing_loss = 0.9;
  double outliers = 0.002;  ///< probability that a return is anywhere on its ray within the bounding sphere
  /// Probability that a return is between two surfaces, where the ray, as wide as half an angular step, grazes the edge
  /// of one and sees the other.
  double mixed_pixels = 0.5;
  /// Sigmas of the motion by which each view as a whole is out of place: the angle of a turn around the middle of the
  /// part about a random axis, and each coordinate of a shift.
  double rotation_deg = 0.02;
  double translation = 0.0003;

  bool with_normals = false;    ///< the true ones, outward: for tests, no scanner knows them
  MeshingOptions meshing = {};  ///< scan_model(): the mesh that tells what a ray hits first
  std::uint64_t seed = 1;
};

/// The same scanner without noise, quantisation, missing returns, outliers, mixed pixels and misregistration.
[[nodiscard]] ScanOptions without_defects(ScanOptions options);

/// What scanners see of a mesh: the first hit of each ray, from both sides of triangles, with the defects of the
/// options. Sensor positions are where the registration of the views puts them, moved along with the points.
/// Points come view by view, row by row. The result does not depend on the number of threads. (Rays that hit within
/// rounding of an edge may take either of its triangles on machines with other instruction sets.)
/// O(triangles log triangles + rays log triangles).
/// @throws Error naming the option that is out of range, or when there is nothing to see; Cancelled.
[[nodiscard]] PointCloud scan_mesh(const TriangleMesh& mesh, const ScanOptions& options = {},
                                   const RunContext& run = {});

/// The same for a model: its mesh tells what each ray hits first, the model's formulas where exactly. What is thinner
/// than a few cells of the mesh may be missed.
/// @throws Error as scan_mesh(), and when the solid is empty or unbounded; Cancelled.
[[nodiscard]] PointCloud scan_model(const CsgTree& tree, const PrimitiveSet& primitives,
                                    const ScanOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
