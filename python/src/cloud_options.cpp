#include "bindings.hpp"
#include "cloud2csg/advanced/clean.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/compare.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/sample.hpp"
#include "option_class.hpp"

namespace cloud2csg::python {
namespace {

void bind_reading(py::module_& module) {
  OptionClass<InputOptions>(module, "InputOptions", "How a cloud is read: see read_cloud().")
      .field("mesh_points", &InputOptions::mesh_points, "Points to draw from a mesh.")
      .field("seed", &InputOptions::seed, "Of the draw.")
      .finish();
  OptionClass<CloudWriteOptions>(module, "CloudWriteOptions", "How a cloud is written: see PointCloud.write().")
      .field("binary", &CloudWriteOptions::binary, "Of .ply and .pcd; the others are text always.")
      .field("double_precision", &CloudWriteOptions::double_precision,
             "Keeps every bit, in text too; False: single precision, a file of half the size.")
      .finish();
  OptionClass<CleanOptions>(module, "CleanOptions", "Which points of a raw cloud are left out.")
      .field("remove_outliers", &CleanOptions::remove_outliers, "Leave out points that no surface goes through.")
      .field("point_budget", &CleanOptions::point_budget, "More points than this are thinned.")
      .finish();
  OptionClass<PrepareOptions>(module, "PrepareOptions", "From a raw cloud to one to detect surfaces in.")
      .nested("clean", &PrepareOptions::clean, "Which points are left out.")
      .field("is_exact", &PrepareOptions::is_exact,
             "The points lie on the surface and have its normals, as those drawn from a mesh: they are taken as they "
             "are. extract() and detect() set it for clouds with PointCloud.is_exact.")
      .field("keep_normals", &PrepareOptions::keep_normals,
             "Keep given normals that are plausible. False: estimate them in any case.")
      .finish();
}

void bind_sampling(py::module_& module) {
  OptionClass<SampleOptions>(module, "SampleOptions", "How points are drawn from a surface: see sample().")
      .field("count", &SampleOptions::count, "Points to make; used when density is 0.")
      .field("density", &SampleOptions::density, "Points per unit of area; 0: use count. Models only.")
      .field("noise", &SampleOptions::noise,
             "Standard deviation of the Gaussian displacement of each coordinate, in the model's units.")
      .field("normal_noise_deg", &SampleOptions::normal_noise_deg,
             "Standard deviation of the angle by which normals are tilted, in degrees. Models only.")
      .field("seed", &SampleOptions::seed, "The same seed gives the same points.")
      .finish();
}

void bind_scanning(py::module_& module) {
  OptionClass<MeshingOptions>(module, "MeshingOptions", "How the surface of a solid becomes triangles.")
      .field("resolution", &MeshingOptions::resolution, "Cells along the longest side of the bounds: 4 to 4096.")
      .field("corners_first", &MeshingOptions::corners_first,
             "Keep the corners even where that makes a few of the small triangles around them overlap.")
      .finish();
  OptionClass<ScanOptions>(module, "ScanOptions",
                           "A range scanner put around a part: see scan(). Lengths are shares of the diagonal of the "
                           "part's bounds where nothing else is said.")
      .field("views", &ScanOptions::views, "Sensors, spread evenly over a sphere around the part.")
      .field("on_table", &ScanOptions::on_table,
             "The part lies on a table, its z axis upright: sensors are above its middle only.")
      .field("distance", &ScanOptions::distance, "From the middle to each sensor, in bounding radii; more than 1.")
      .field("field_of_view_deg", &ScanOptions::field_of_view_deg,
             "Width and height of what a view sees, up to 170 degrees; 0: just the bounding sphere.")
      .field("count", &ScanOptions::count, "Points in all; used when angular_step_deg is 0.")
      .field("angular_step_deg", &ScanOptions::angular_step_deg,
             "Between neighbouring rays of a view, in degrees; 0: what gives `count` points.")
      .field("noise", &ScanOptions::noise, "Standard deviation of the error along the ray.")
      .field("quantisation", &ScanOptions::quantisation, "The range is a multiple of this; 0: any number.")
      .field("grazing_angle_deg", &ScanOptions::grazing_angle_deg,
             "From this incidence on returns are missing, in degrees.")
      .field("grazing_loss", &ScanOptions::grazing_loss, "... with a probability that grows up to this at 90 degrees.")
      .field("outliers", &ScanOptions::outliers, "Probability that a return is anywhere on its ray.")
      .field("mixed_pixels", &ScanOptions::mixed_pixels,
             "Probability that a return is between two surfaces where the ray grazes an edge.")
      .field("rotation_deg", &ScanOptions::rotation_deg,
             "Standard deviation of the angle by which each view is turned, in degrees.")
      .field("translation", &ScanOptions::translation, "... and of each coordinate by which it is moved.")
      .field("with_normals", &ScanOptions::with_normals, "The true ones, outward: no scanner knows them.")
      .nested("meshing", &ScanOptions::meshing, "Models: the mesh that tells what a ray hits first.")
      .field("seed", &ScanOptions::seed, "The same seed gives the same scan.")
      .finish()
      .def("without_defects", &without_defects,
           "The same scanner without noise, missing returns, outliers and views out of place.");
}

}  // namespace

void bind_cloud_options(py::module_& module) {
  bind_reading(module);
  bind_sampling(module);
  bind_scanning(module);
  OptionClass<CompareOptions>(module, "CompareOptions", "How two solids are compared: see compare().")
      .field("resolution", &CompareOptions::resolution,
             "About resolution^2 columns through the joint bounds, for the volumes; 2 to 8192.")
      .field("surface_samples", &CompareOptions::surface_samples,
             "Points on each surface that is not a cloud, for the distances.")
      .field("seed", &CompareOptions::seed, "Of the surface samples.")
      .finish();
}

}  // namespace cloud2csg::python
