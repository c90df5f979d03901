#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <set>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/view.hpp"
#include "field_arrays.hpp"
#include "io/formats/formats.hpp"
#include "model.hpp"
#include "option_class.hpp"
#include "reports.hpp"
#include "shape/mesh/model_extent.hpp"
#include "tree_nodes.hpp"

namespace cloud2csg::python {

PrimitiveSet to_primitives(const py::object& primitives) {
  if (py::isinstance<Model>(primitives)) return primitives.cast<const Model&>().primitives;
  PrimitiveSet set;
  std::set<std::string> ids;
  for (const py::handle& primitive : py::iter(primitives)) {
    if (!py::isinstance<Primitive>(primitive)) {
      throw py::type_error(
          fmt::format("primitives: expected Primitive, found {}", py::repr(primitive).cast<std::string>()));
    }
    set.push_back(primitive.cast<Primitive>());
    if (!ids.insert(set.back().id).second) {
      throw Error({.where = fmt::format("primitives/{}/id", set.size() - 1),
                   .expected = fmt::format("expected an id of its own, found \"{}\" again", set.back().id)});
    }
  }
  return set;
}

ExportReport write_any(const std::filesystem::path& file, const Report& report,
                       const std::optional<ExportOptions>& options, const RunArguments& arguments) {
  check_overwriting(file);
  return run_work(arguments, [&](const RunContext& run) {
    if (has_ending_of(file, FileKind::page)) {
      write_report(file, report, {}, run);
    } else if (has_ending_of(file, FileKind::picture)) {
      write_picture(file, {.model = report.model, .cloud = report.cloud, .colours = {}}, {}, run);
    } else {
      return export_model(file, report.model, options.value_or(ExportOptions{}), run);
    }
    return ExportReport{};
  });
}

std::string summary_of(const Model& model) {
  return fmt::format("{} primitives, {}", model.primitives.size(),
                     model.tree ? fmt::format("tree of {} nodes", model.tree->size()) : "no tree");
}

namespace {

using ModelClass = py::class_<Model, std::shared_ptr<Model>>;

Model make_model(const py::object& primitives, const py::object& tree, std::string description) {
  Model model{.primitives = to_primitives(primitives), .tree = {}, .description = std::move(description)};
  if (!tree.is_none()) model.tree = to_tree(tree, model.primitives);
  return model;
}

/// read_model() checks the content, whatever the file's ending.
Model read_file(const std::filesystem::path& file) {
  const py::gil_scoped_release unlocked;
  return read_model(file);
}

Report report_of(const Model& model, const py::object& cloud, const std::string& title) {
  Report report{.title = title, .source = model.description, .model = model};
  if (!cloud.is_none()) report.cloud = to_cloud(cloud).cast<const Cloud&>().points();
  return report;
}

py::object box_or_none(const std::optional<AlignedBox>& box) {
  return box ? py::object(to_array(*box)) : py::none();
}

void bind_export_reports(py::module_& module) {
  py::class_<FailedNode>(module, "FailedNode", "A node whose exact solid could not be had: written with facets.")
      .def_readonly("node", &FailedNode::node, "As the text form writes it, shortened when long.")
      .def_readonly("reason", &FailedNode::reason, "One line.");
  py::class_<BrepReport>(module, "BrepReport", "What was written to .step or .brep, as far as the file does not say.")
      .def_readonly("volume", &BrepReport::volume, "Of the solid in the file, in cubed units.")
      .def_readonly("tree_volume", &BrepReport::tree_volume, "Of the tree, by samples.")
      .def_readonly("tree_volume_error", &BrepReport::tree_volume_error, "Standard error of that.")
      .def_property_readonly("volume_difference", &BrepReport::volume_difference, "As a part of the tree's.")
      .def_readonly("is_valid", &BrepReport::is_valid, "Whether the kernel finds no fault in the solid.")
      .def_readonly("solids", &BrepReport::solids, "Separate bodies.")
      .def_readonly("faces", &BrepReport::faces, "How many.")
      .def_readonly("healed_faces", &BrepReport::healed_faces, "Faces that were invalid before they were mended.")
      .def_readonly("faceted", &BrepReport::faceted, "Indices of primitives without exact surfaces.")
      .def_readonly("failed", &BrepReport::failed, "Nodes written with facets: list of FailedNode.");
  py::class_<ExportReport>(module, "ExportReport", "What a written file does not say of itself.")
      .def_property_readonly(
          "cut_at", [](const ExportReport& self) { return box_or_none(self.cut_at); },
          "The box at which a solid without bounds was cut, shape (2, 3), or None.")
      .def_readonly("brep", &ExportReport::brep, "Of .step and .brep: BrepReport, or None.");
}

void bind_content(ModelClass& model) {
  model.def(py::init(&make_model), py::arg("primitives"), py::arg("tree") = py::none(), py::arg("description") = "")
      .def_property_readonly(
          "primitives", [](const Model& self) { return py::tuple(py::cast(self.primitives)); },
          "tuple of Primitive: copies.")
      .def_property_readonly(
          "tree",
          [](const Model& self) -> py::object {
            return self.tree ? to_nodes(*self.tree, self.primitives) : py::none();
          },
          "The tree as nested objects (see cloud2csg.tree), or None.")
      .def_readonly("description", &Model::description, "Free text on where the model comes from.")
      .def_readonly("warnings", &Model::warnings, "Sentences: what was doubtful when the model was read.")
      .def_property_readonly(
          "size", [](const Model& self) { return tree_of(self).size(); },
          "Nodes of the tree as a binary one, as in the paper. Raises Error without a tree.")
      .def_property_readonly(
          "leaf_count", [](const Model& self) { return leaf_count(tree_of(self)); },
          "Leaves that are primitives, each as often as it appears. Raises Error without a tree.")
      .def_property_readonly(
          "depth", [](const Model& self) { return depth(tree_of(self)); },
          "Edges from the root to the deepest leaf of the binary tree. Raises Error without a tree.")
      .def_property_readonly(
          "bounds", [](const Model& self) { return to_array(bounds_of(self)); },
          "[[least x, y, z], [greatest x, y, z]] around the solid, shape (2, 3); may be infinite.")
      .def(
          "simplified",
          [](const Model& self) {
            return Model{self.primitives, simplify(tree_of(self)), self.description};
          },
          "The same solid with a tree by the rules of set algebra, never larger.");
}

void bind_texts(ModelClass& model) {
  model
      .def_static(
          "from_json", [](const std::string& text) { return parse_model(text); }, py::arg("text"),
          "From the text of a model file. Raises Error with the path of the field that is wrong.")
      .def_static("read", &read_file, py::arg("file"),
                  "Reads a model file (.json), or one of OpenSCAD (.scad .csg). Raises Error.")
      .def(
          "to_json", [](const Model& self) { return to_json(self); }, "The text of a model file.")
      .def(
          "to_scad",
          [](const Model& self, const std::optional<OpenScadOptions>& options) {
            return to_openscad(self, options.value_or(OpenScadOptions{}));
          },
          py::arg("options") = py::none(), "The OpenSCAD program. Raises Error without a tree.")
      .def(
          "to_graphviz", [](const Model& self) { return to_graphviz(self); },
          "The tree for Graphviz. Raises Error without a tree.")
      .def(
          "to_text", [](const Model& self) { return to_text(tree_of(self), self.primitives); },
          "The tree in one line, e.g. '(plate | boss) - bore'. Raises Error without a tree.")
      .def("__repr__", [](const Model& self) { return fmt::format("<cloud2csg.Model: {}>", summary_of(self)); })
      .def("__eq__",
           [](const Model& self, const py::object& other) {
             return py::isinstance<Model>(other) && to_json(self) == to_json(other.cast<const Model&>());
           })
      .def(py::pickle([](const Model& self) { return to_json(self); },
                      [](const std::string& text) { return parse_model(text); }));
  model.attr("__hash__") = py::none();
}

void bind_fields(ModelClass& model) {
  model
      .def(
          "distance",
          [](const Model& self, const py::object& points, int threads) {
            const CsgTree& tree = tree_of(self);
            return distances_at(points, {.threads = threads},
                                [&](PointsView at) { return implicit_value(tree, self.primitives, at); });
          },
          py::arg("points"), py::kw_only(), py::arg("threads") = 0,
          "The tree's distance field at points of shape (n, 3), in any layout, float64 without a copy: shape (n,), in "
          "the model's units. Negative inside; the distance near the surface, a lower bound elsewhere; +inf for the "
          "empty solid.")
      .def(
          "gradient",
          [](const Model& self, const py::object& points, int threads) {
            const CsgTree& tree = tree_of(self);
            return gradients_at(points, {.threads = threads},
                                [&](PointsView at) { return implicit_gradient(tree, self.primitives, at); });
          },
          py::arg("points"), py::kw_only(), py::arg("threads") = 0,
          "The gradient of distance() at points of shape (n, 3): shape (n, 3), that of the primitive whose value the "
          "tree takes, not normalised; outward on the surface.");
}

void bind_outputs(ModelClass& model) {
  model
      .def(
          "mesh",
          [](const Model& self, const std::optional<MeshingOptions>& options, int threads, const py::object& progress,
             const py::kwargs& fields) {
            const MeshingOptions meshing = with_fields(options, fields);
            return run_work({.threads = threads, .progress = progress}, [&](const RunContext& run) {
              return mesh_surface(self, model_extent(self), meshing, run);
            });
          },
          py::arg("options") = py::none(), py::kw_only(), py::arg("threads") = 0, py::arg("progress") = py::none(),
          "The surface as a closed TriangleMesh with sharp edges. Further keywords are fields of MeshingOptions. What "
          "has no bounds is cut at a box around its primitives.")
      .def(
          "write",
          [](const Model& self, const std::filesystem::path& file, const std::optional<ExportOptions>& options,
             int threads, const py::object& progress) {
            return write_any(file, report_of(self, py::none(), file.stem().string()), options,
                             {.threads = threads, .progress = progress});
          },
          py::arg("file"), py::arg("options") = py::none(), py::kw_only(), py::arg("threads") = 0,
          py::arg("progress") = py::none(),
          "Writes by the file's ending: .json .scad .csg .FCMacro .py .step .stp .brep .stl .off .obj .3mf .dot .html "
          ".png. "
          "All but .json need a tree. Nothing half-written; a file of another kind is not overwritten. Returns "
          "ExportReport; raises Error.")
      .def(
          "picture",
          [](const Model& self, const py::object& cloud, const std::optional<PictureOptions>& options, int threads,
             const py::object& progress, const py::kwargs& fields) {
            const Report report = report_of(self, cloud, "");
            const PictureOptions picture = with_fields(options, fields);
            const Image image = run_work({.threads = threads, .progress = progress}, [&](const RunContext& run) {
              return draw_picture({.model = report.model, .cloud = report.cloud, .colours = {}}, picture, run);
            });
            return py::array_t<std::uint8_t>({image.height, image.width, 3}, image.rgb.data());
          },
          py::arg("cloud") = py::none(), py::kw_only(), py::arg("options") = py::none(), py::arg("threads") = 0,
          py::arg("progress") = py::none(),
          "The solid in the colours of its primitives, with a cloud (PointCloud, or positions of shape (n, 3)) on its "
          "left: red, green and blue, shape (height, width, 3), uint8. Further keywords are fields of PictureOptions.");
}

void bind_pages(ModelClass& model) {
  model
      .def(
          "report",
          [](const Model& self, const py::object& cloud, const std::string& title,
             const std::optional<ReportOptions>& options, int threads, const py::object& progress) {
            const Report report = report_of(self, cloud, title);
            return run_work({.threads = threads, .progress = progress}, [&](const RunContext& run) {
              return report_page(report, options.value_or(ReportOptions{}), run);
            });
          },
          py::arg("cloud") = py::none(), py::kw_only(), py::arg("title") = "", py::arg("options") = py::none(),
          py::arg("threads") = 0, py::arg("progress") = py::none(),
          "The text of an HTML page that shows the model, with a cloud (PointCloud, or positions of shape (n, 3)) how "
          "far apart the two are. Needs nothing else, no network either. Raises Error in builds without the viewer.")
      .def(
          "_repr_html_",
          [](const Model& self) {
            return html_of(report_of(self, py::none(), {}), fmt::format("cloud2csg.Model: {}", summary_of(self)));
          },
          "The viewer, for notebooks; a line of text where there is no tree or no viewer in this build.");
}

}  // namespace

void bind_models(py::module_& module) {
  bind_export_reports(module);
  ModelClass model(module, "Model",
                   "Primitives and, where known, the tree over them. Does not change.\n\n"
                   "primitives: iterable of Primitive, or a Model. tree: a node of cloud2csg.tree, a text such as "
                   "'(a | b) - c', or None. description: free text.\n\n"
                   "Raises Error for an id that is there twice, or that no primitive has.");
  bind_content(model);
  bind_texts(model);
  bind_fields(model);
  bind_outputs(model);
  bind_pages(model);
  module.def("has_viewer", &has_report_page, "Whether this build has the page of reports.");
  module.def("has_brep", &has_brep, "Whether this build writes .step and .brep files.");
}

}  // namespace cloud2csg::python
