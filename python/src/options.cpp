#include "bindings.hpp"
#include "cloud2csg/compare.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "cloud2csg/view.hpp"
#include "option_class.hpp"

/// The option classes; those within others come first. Their fields are those of the tables beside the structs.
namespace cloud2csg::python {
namespace {

void bind_cloud_options(py::module_& module) {
  OptionClass<InputOptions>(module, "InputOptions", "How a cloud is read: see read_cloud().");
  OptionClass<CloudWriteOptions>(module, "CloudWriteOptions", "How a cloud is written: see PointCloud.write().");
  OptionClass<CleanOptions>(module, "CleanOptions", "Which points of a raw cloud are left out.");
  OptionClass<PrepareOptions>(module, "PrepareOptions", "From a raw cloud to one to detect surfaces in.");
  OptionClass<SampleOptions>(module, "SampleOptions", "How points are drawn from a surface: see sample().");
  OptionClass<MeshingOptions>(module, "MeshingOptions", "How the surface of a solid becomes triangles.");
  OptionClass<ScanOptions>(module, "ScanOptions",
                           "A range scanner put around a part: see scan(). Lengths are shares of the diagonal of the "
                           "part's bounds where nothing else is said.")
      .python()
      .def("without_defects", &without_defects,
           "The same scanner without noise, missing returns, outliers and views out of place.");
  OptionClass<CompareOptions>(module, "CompareOptions", "How two solids are compared: see compare().");
}

void bind_extract_options(py::module_& module) {
  OptionClass<SegmentationOptions>(module, "SegmentationOptions", "Which points lie on which primitive.");
  OptionClass<ObjectiveOptions>(module, "ObjectiveOptions", "Weights of the paper's objective E(t).");
  OptionClass<SampleCounts>(module, "SampleCounts", "How many samples of its surface a primitive gets.");
  OptionClass<LabelOptions>(module, "LabelOptions", "What labels of cells cost.");
  OptionClass<MinimalFormulaOptions>(module, "MinimalFormulaOptions", "How much work a minimal formula may take.");
  OptionClass<LocalSearchOptions>(module, "LocalSearchOptions", "Climbing by the best of all small changes of a tree.");
  OptionClass<CellSolveOptions>(module, "CellSolveOptions", "From labelled cells to a small tree.");
  OptionClass<GaOptions>(module, "GaOptions", "The search for the tree of one partition.");
  OptionClass<ExtractOptions>(module, "ExtractOptions", "From a cloud and known primitives to a tree: see extract().")
      .python()
      .def_static("paper", &paper_options, "As in the paper: its weights, its genetic algorithm, no polish.");
  OptionClass<RefineOptions>(module, "RefineOptions", "Primitives moved to where the points are: see extract().");
  OptionClass<DetectOptions>(module, "DetectOptions", "How surfaces are detected: see detect().");
  OptionClass<PlaceOptions>(module, "PlaceOptions", "Places by which solids are judged.");
  OptionClass<RegularityOptions>(module, "RegularityOptions", "What of the surfaces is made regular.");
  OptionClass<SolidOptions>(module, "SolidOptions", "How solids are chosen that the surfaces bound.");
  OptionClass<ReconstructOptions>(module, "ReconstructOptions", "From a raw cloud to a tree: see extract().");
}

void bind_output_options(py::module_& module) {
  OptionClass<OpenScadOptions>(module, "OpenScadOptions", "How an OpenSCAD program is written.");
  OptionClass<ScriptOptions>(module, "ScriptOptions", "How scripts in Python are written (.FCMacro, .py).");
  OptionClass<BrepOptions>(module, "BrepOptions", "How exact solids are written (.step, .brep).");
  OptionClass<ExportOptions>(module, "ExportOptions", "How a model is written: see Model.write().");
  OptionClass<PictureOptions>(module, "PictureOptions", "How large a picture is, and from where: see Model.picture().");
  OptionClass<ReportOptions>(module, "ReportOptions", "How large the page of a report is: see Model.report().");
}

}  // namespace

void bind_options(py::module_& module) {
  bind_cloud_options(module);
  bind_extract_options(module);
  bind_output_options(module);
}

}  // namespace cloud2csg::python
