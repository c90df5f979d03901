#include "cloud2csg/extract.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "model.hpp"
#include "raw_options.hpp"
#include "reports.hpp"
#include "result.hpp"

namespace cloud2csg::python {
namespace {

using AnyOptions = std::optional<std::variant<ExtractOptions, ReconstructOptions>>;

std::optional<RefineOptions> refine_options(const py::object& refine, const ExtractOptions& options) {
  if (py::isinstance<RefineOptions>(refine)) return refine.cast<RefineOptions>();
  if (!py::isinstance<py::bool_>(refine)) throw py::type_error("refine: expected a bool or RefineOptions");
  if (!refine.cast<bool>()) return std::nullopt;
  return refine_options_for(options);
}

/// `seed` and `refine` override the options.
ReconstructOptions asked_for(const AnyOptions& options, const Cloud& cloud, std::optional<std::uint64_t> seed,
                             const py::object& refine) {
  ReconstructOptions raw;
  if (options && std::holds_alternative<ExtractOptions>(*options)) {
    raw.extraction = std::get<ExtractOptions>(*options);
  } else if (options) {
    raw = std::get<ReconstructOptions>(*options);
  }
  raw = raw_options(raw, cloud, seed);
  if (const std::optional<RefineOptions> given = refine_options(refine, raw.extraction)) raw.refine = given;
  return raw;
}

Extraction extract_over(const Cloud& cloud, const PrimitiveSet& primitives, const ReconstructOptions& options,
                        const RunContext& run) {
  validate(options);
  if (!options.refine) return extract_csg(cloud.points(), primitives, options.extraction, run);
  return extract_refined_csg(cloud.points(), primitives, options.extraction, *options.refine, run);
}

Result extract(const py::object& cloud, const py::object& primitives, const AnyOptions& options,
               std::optional<std::uint64_t> seed, const py::object& refine, int threads, const py::object& progress) {
  const auto given = to_cloud(cloud).cast<std::shared_ptr<Cloud>>();
  const ReconstructOptions asked = asked_for(options, *given, seed, refine);
  const RunArguments arguments{.threads = threads, .progress = progress};
  if (primitives.is_none()) {
    return result_of(
        run_work(arguments, [&](const RunContext& run) { return reconstruct(given->points(), asked, run); }), given);
  }
  const PrimitiveSet known = to_primitives(primitives);
  return result_of(run_work(arguments, [&](const RunContext& run) { return extract_over(*given, known, asked, run); }),
                   given);
}

py::object statistics_of(const Result& result) {
  return py::module_::import("json").attr("loads")(to_json(result.statistics));
}

py::array_t<std::uint32_t> unexplained_in(const Result& self, int threads, const py::object& progress) {
  const std::vector<std::uint32_t> indices =
      run_work({.threads = threads, .progress = progress}, [&](const RunContext& run) {
        return unexplained_points(*self.model, self.cloud->points(), self.statistics.fit.tolerances, run);
      });
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(indices.size()), indices.data());
}

Report report_of(const Result& result, const std::string& title) {
  return {.title = title,
          .source = fmt::format("{} points", result.cloud->points().size()),
          .model = *result.model,
          .cloud = result.cloud->points(),
          .statistics = result.statistics};
}

std::string repr_of_result(const Result& self) {
  return fmt::format("<cloud2csg.Result: {}, rms distance {:.4g}{}>", summary_of(*self.model),
                     self.statistics.fit.rms_distance, self.statistics.complete ? "" : ", stopped early");
}

void bind_result_outputs(py::class_<Result>& result) {
  result
      .def("unexplained_points", &unexplained_in, py::kw_only(), py::arg("threads") = 0,
           py::arg("progress") = py::none(),
           "Indices into `cloud` of the points that the tree contradicts: farther from its surface than the tolerance "
           "of the extraction, or with a different normal. Ascending, shape (k,), uint32.")
      .def(
          "write",
          [](const Result& self, const std::filesystem::path& file, const std::optional<ExportOptions>& options,
             int threads, const py::object& progress) {
            return write_any(file, report_of(self, file.stem().string()), options,
                             {.threads = threads, .progress = progress});
          },
          py::arg("file"), py::arg("options") = py::none(), py::kw_only(), py::arg("threads") = 0,
          py::arg("progress") = py::none(),
          "Like Model.write(); a report (.html) also shows the cloud and the statistics.")
      .def(
          "report",
          [](const Result& self, const std::string& title, const std::optional<ReportOptions>& options, int threads,
             const py::object& progress) {
            const Report report = report_of(self, title);
            return run_work({.threads = threads, .progress = progress}, [&](const RunContext& run) {
              return report_page(report, options.value_or(ReportOptions{}), run);
            });
          },
          py::kw_only(), py::arg("title") = "", py::arg("options") = py::none(), py::arg("threads") = 0,
          py::arg("progress") = py::none(), "Like Model.report(), with the cloud and the statistics.")
      .def(
          "_repr_html_", [](const Result& self) { return html_of(report_of(self, {}), repr_of_result(self)); },
          "The report for notebooks; a line of text if this build has no viewer.");
}

}  // namespace

void bind_extract(py::module_& module) {
  py::class_<Result> result(module, "Result", "The result of extract() or detect().");
  result.def_readonly("model", &Result::model, "The solids and the tree over them, a Model.")
      .def_readonly("cloud", &Result::cloud, "The points used, with normals, a PointCloud.")
      .def_readonly(
          "surfaces", &Result::surfaces,
          "list of DetectedSurface: the surfaces on which the points lie, if primitives were found in the cloud.")
      .def_property_readonly(
          "statistics", &statistics_of,
          "dict: the content of the file that the command line writes with --stats; times in seconds.")
      .def_property_readonly(
          "verdict",
          [](const Result& self) {
            return py::module_::import("json").attr("loads")(to_json(self.statistics.verdict));
          },
          "dict: how far the result can be trusted: `grade` (\"good\", \"doubtful\" or \"failed\"), `text`, the "
          "figures "
          "behind it, and the `regions` of points that stay unexplained, most points first.")
      .def_property_readonly(
          "warnings", [](const Result& self) { return self.statistics.warnings; },
          "Sentences about the cloud and the work, with places.")
      .def_property_readonly(
          "complete", [](const Result& self) { return self.statistics.complete; },
          "False when a time limit ended the search.")
      .def("__repr__", &repr_of_result);
  bind_result_outputs(result);
  module.def(
      "extract", &extract, py::arg("cloud"), py::arg("primitives") = py::none(), py::arg("options") = py::none(),
      py::kw_only(), py::arg("seed") = py::none(), py::arg("refine") = false, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "Extracts the CSG tree of a point cloud: Result.\n\ncloud: PointCloud, or positions of shape (n, "
      "3).\nprimitives: the solids to combine, a Model or an iterable of Primitive; the cloud then needs normals. "
      "None: find primitives in the cloud, which may be a raw scan.\noptions: ExtractOptions or "
      "ReconstructOptions.\nseed: replaces all seeds in the options. The same seed gives the same tree, for any number "
      "of threads.\nrefine: True or RefineOptions: fit positions, directions and sizes of the primitives to the "
      "points, and extract the tree again.\nthreads: 0 = all cores.\nprogress: callable(stage: str, done: int, total: "
      "int), called from this thread; total is 0 if unknown. An exception in it stops the work and is passed "
      "on.\n\nReleases the interpreter's lock during the work, and Ctrl-C (KeyboardInterrupt) stops it soon. Raises "
      "Error when the cloud has too few points or no inside, no surface is found, or no point is near any primitive.");
}

}  // namespace cloud2csg::python
