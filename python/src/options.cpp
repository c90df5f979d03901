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
  add_options<InputOptions>(module, "InputOptions", "How a cloud is read: see read_cloud().");
  add_options<CloudWriteOptions>(module, "CloudWriteOptions", "How a cloud is written: see PointCloud.write().");
  add_options<CleanOptions>(module, "CleanOptions", "Which points of a raw cloud are left out.");
  add_options<PrepareOptions>(module, "PrepareOptions", "From a raw cloud to one to detect surfaces in.");
  add_options<SampleOptions>(module, "SampleOptions", "How points are drawn from a surface: see sample().");
  add_options<MeshingOptions>(module, "MeshingOptions", "How the surface of a solid becomes triangles.");
  add_options<ScanOptions>(module, "ScanOptions",
                           "A range scanner put around a part: see scan(). Lengths are shares of the diagonal of the "
                           "part's bounds where nothing else is said.")
      .def("without_defects", &without_defects,
           "The same scanner without noise, missing returns, outliers and views out of place.");
  add_options<CompareOptions>(module, "CompareOptions", "How two solids are compared: see compare().");
}

void bind_extract_options(py::module_& module) {
  add_options<SegmentationOptions>(module, "SegmentationOptions", "Which points lie on which primitive.");
  add_options<ObjectiveOptions>(module, "ObjectiveOptions", "Weights of the paper's objective E(t).");
  add_options<SampleCounts>(module, "SampleCounts", "How many samples of its surface a primitive gets.");
  add_options<LabelOptions>(module, "LabelOptions", "What labels of cells cost.");
  add_options<MinimalFormulaOptions>(module, "MinimalFormulaOptions", "How much work a minimal formula may take.");
  add_options<LocalSearchOptions>(module, "LocalSearchOptions", "Climbing by the best of all small changes of a tree.");
  add_options<CellSolveOptions>(module, "CellSolveOptions", "From labelled cells to a small tree.");
  add_options<GaOptions>(module, "GaOptions", "The search for the tree of one partition.");
  add_options<ExtractOptions>(module, "ExtractOptions", "From a cloud and known primitives to a tree: see extract().")
      .def_static("paper", &paper_options, "As in the paper: its weights, its genetic algorithm, no polish.");
  add_options<RefineOptions>(module, "RefineOptions", "Primitives moved to where the points are: see extract().");
  add_options<DetectOptions>(module, "DetectOptions", "How surfaces are detected: see detect().");
  add_options<PlaceOptions>(module, "PlaceOptions", "Places by which solids are judged.");
  add_options<RegularityOptions>(module, "RegularityOptions", "What of the surfaces is made regular.");
  add_options<SolidOptions>(module, "SolidOptions", "How solids are chosen that the surfaces bound.");
  add_options<ReconstructOptions>(module, "ReconstructOptions", "From a raw cloud to a tree: see extract().");
}

void bind_output_options(py::module_& module) {
  add_options<OpenScadOptions>(module, "OpenScadOptions", "How an OpenSCAD program is written.");
  add_options<ScriptOptions>(module, "ScriptOptions", "How scripts in Python are written (.FCMacro, .py).");
  add_options<BrepOptions>(module, "BrepOptions", "How exact solids are written (.step, .brep).");
  add_options<ExportOptions>(module, "ExportOptions", "How a model is written: see Model.write().");
  add_options<PictureOptions>(module, "PictureOptions", "How large a picture is, and from where: see Model.picture().");
  add_options<ReportOptions>(module, "ReportOptions", "How large the page of a report is: see Model.report().");
}

}  // namespace

void bind_options(py::module_& module) {
  bind_cloud_options(module);
  bind_extract_options(module);
  bind_output_options(module);
}

}  // namespace cloud2csg::python
