#include "bindings.hpp"
#include "cloud2csg/compare.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "cloud2csg/view.hpp"
#include "option_class.hpp"

/// The option classes, nested ones first. The tables beside the structs define their fields.
namespace cloud2csg::python {
namespace {

void bind_cloud_options(py::module_& module) {
  add_options<InputOptions>(module, "InputOptions", "Options for reading a cloud: see read_cloud().");
  add_options<CloudWriteOptions>(module, "CloudWriteOptions", "Options for writing a cloud: see PointCloud.write().");
  add_options<CleanOptions>(module, "CleanOptions", "Removal of points from a raw cloud.");
  add_options<PrepareOptions>(module, "PrepareOptions", "Preparation of a raw cloud for the detection of surfaces.");
  add_options<SampleOptions>(module, "SampleOptions", "Options for drawing points from a surface: see sample().");
  add_options<MeshingOptions>(module, "MeshingOptions", "Triangulation of a solid's surface.");
  add_options<ScanOptions>(module, "ScanOptions",
                           "A simulated range scanner around a part: see scan(). Lengths are shares of the diagonal of "
                           "the part's bounds unless stated otherwise.")
      .def("without_defects", &without_defects,
           "The same scanner without noise, missing returns, outliers and misregistration of views.");
  add_options<CompareOptions>(module, "CompareOptions", "Options for comparing two solids: see compare().");
}

void bind_extract_options(py::module_& module) {
  add_options<SegmentationOptions>(module, "SegmentationOptions", "Assignment of points to primitives.");
  add_options<ObjectiveOptions>(module, "ObjectiveOptions", "Weights of the paper's objective E(t).");
  add_options<SampleCounts>(module, "SampleCounts", "Number of samples on the surface of each primitive.");
  add_options<LabelOptions>(module, "LabelOptions", "Costs of labelling cells as in or out of the solid.");
  add_options<MinimalFormulaOptions>(module, "MinimalFormulaOptions", "Limits on the search for a minimal formula.");
  add_options<LocalSearchOptions>(module, "LocalSearchOptions",
                                  "Local search that repeatedly makes the best small change of a tree.");
  add_options<CellSolveOptions>(module, "CellSolveOptions", "Search for a small tree with the labels of the cells.");
  add_options<GaOptions>(module, "GaOptions", "Search for the tree of one partition, by the genetic algorithm.");
  add_options<ExtractOptions>(module, "ExtractOptions",
                              "Extraction of a tree from a cloud and known primitives: see extract().")
      .def_static("paper", &paper_options, "The paper's options: its weights, its genetic algorithm, no polish.");
  add_options<RefineOptions>(module, "RefineOptions", "Refinement of the primitives to fit the points: see extract().");
  add_options<DetectOptions>(module, "DetectOptions", "Detection of surfaces: see detect().");
  add_options<PlaceOptions>(module, "PlaceOptions", "Sample places by which solids are judged.");
  add_options<RegularityOptions>(module, "RegularityOptions", "Regularity of the surfaces.");
  add_options<SolidOptions>(module, "SolidOptions", "Choice of the solids that the surfaces bound.");
  add_options<ReconstructOptions>(module, "ReconstructOptions",
                                  "Reconstruction of a tree from a raw cloud: see extract().");
}

void bind_output_options(py::module_& module) {
  add_options<OpenScadOptions>(module, "OpenScadOptions", "Options of OpenSCAD files.");
  add_options<ScriptOptions>(module, "ScriptOptions", "Options of scripts in Python (.FCMacro, .py).");
  add_options<BrepOptions>(module, "BrepOptions", "Options of files of exact solids (.step, .brep).");
  add_options<ExportOptions>(module, "ExportOptions", "Options for writing a model: see Model.write().");
  add_options<PictureOptions>(module, "PictureOptions", "Size and viewpoint of a picture: see Model.picture().");
  add_options<ReportOptions>(module, "ReportOptions", "Limits on the size of a report page: see Model.report().");
}

}  // namespace

void bind_options(py::module_& module) {
  bind_cloud_options(module);
  bind_extract_options(module);
  bind_output_options(module);
}

}  // namespace cloud2csg::python
