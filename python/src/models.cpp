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
                   .expected = fmt::format("expected a unique id, found \"{}\" again", set.back().id)});
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
  py::class_<FailedNode>(module, "FailedNode",
                         "A node whose exact solid could not be made, so that it was written with facets.")
      .def_readonly("node", &FailedNode::node, "The node in text form, shortened when long.")
      .def_readonly("reason", &FailedNode::reason, "The reason, in one line.");
  py::class_<BrepReport>(module, "BrepReport", "What the written .step or .brep file does not show by itself.")
      .def_readonly("volume", &BrepReport::volume, "Volume of the solid in the file, in cubed units.")
      .def_readonly("tree_volume", &BrepReport::tree_volume, "Volume of the tree, estimated from samples.")
      .def_readonly("tree_volume_error", &BrepReport::tree_volume_error, "Standard error of tree_volume.")
      .def_property_readonly("volume_difference", &BrepReport::volume_difference,
                             "Difference of the two volumes, as a share of the tree's.")
      .def_readonly("is_valid", &BrepReport::is_valid, "Whether the CAD kernel finds no fault in the solid.")
      .def_readonly("solids", &BrepReport::solids, "Number of separate bodies.")
      .def_readonly("faces", &BrepReport::faces, "Number of faces.")
      .def_readonly("healed_faces", &BrepReport::healed_faces,
                    "Number of faces that were invalid before they were repaired.")
      .def_readonly("faceted", &BrepReport::faceted, "Indices of primitives without exact surfaces.")
      .def_readonly("failed", &BrepReport::failed, "Nodes written with facets: list of FailedNode.");
  py::class_<ExportReport>(module, "ExportReport", "What the written file does not show by itself.")
      .def_property_readonly(
          "cut_at", [](const ExportReport& self) { return box_or_none(self.cut_at); },
          "The box at which an unbounded solid was cut, shape (2, 3), or None.")
      .def_readonly("brep", &ExportReport::brep, "BrepReport of a .step or .brep file, or None.");
}

void bind_content(ModelClass& model) {
  model.def(py::init(&make_model), py::arg("primitives"), py::arg("tree") = py::none(), py::arg("description") = "")
      .def_property_readonly(
          "primitives", [](const Model& self) { return py::tuple(py::cast(self.primitives)); },
          "Copies of the primitives: tuple of Primitive.")
      .def_property_readonly(
          "tree",
          [](const Model& self) -> py::object {
            return self.tree ? to_nodes(*self.tree, self.primitives) : py::none();
          },
          "The tree as nested objects (see cloud2csg.tree), or None.")
      .def_readonly("description", &Model::description, "Free text on the origin of the model.")
      .def_readonly("warnings", &Model::warnings, "Sentences about doubts when the model was read.")
      .def_property_readonly(
          "size", [](const Model& self) { return tree_of(self).size(); },
          "Nodes of the tree in binary form, as in the paper. Raises Error without a tree.")
      .def_property_readonly(
          "leaf_count", [](const Model& self) { return leaf_count(tree_of(self)); },
          "Number of primitives in the tree, counting repetitions. Raises Error without a tree.")
      .def_property_readonly(
          "depth", [](const Model& self) { return depth(tree_of(self)); },
          "Number of edges from the root to the deepest leaf of the binary tree. Raises Error without a tree.")
      .def_property_readonly(
          "bounds", [](const Model& self) { return to_array(bounds_of(self)); },
          "[[least x, y, z], [greatest x, y, z]] of a box around the solid, shape (2, 3); may be infinite.")
      .def(
          "simplified",
          [](const Model& self) {
            return Model{self.primitives, simplify(tree_of(self)), self.description};
          },
          "The same solid with the tree simplified by the rules of set algebra; never larger.");
}

void bind_texts(ModelClass& model) {
  model
      .def_static(
          "from_json", [](const std::string& text) { return parse_model(text); }, py::arg("text"),
          "Reads the text of a model file. Raises Error with the path of the wrong field.")
      .def_static("read", &read_file, py::arg("file"),
                  "Reads a model file (.json) or an OpenSCAD file (.scad .csg). Raises Error when that fails.")
      .def(
          "to_json", [](const Model& self) { return to_json(self); }, "The text of a .json model file.")
      .def(
          "to_scad",
          [](const Model& self, const std::optional<OpenScadOptions>& options) {
            return to_openscad(self, options.value_or(OpenScadOptions{}));
          },
          py::arg("options") = py::none(), "The text of an OpenSCAD program. Raises Error without a tree.")
      .def(
          "to_graphviz", [](const Model& self) { return to_graphviz(self); },
          "The tree in Graphviz's language. Raises Error without a tree.")
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
          "Distance field of the tree at points of shape (n, 3), in any layout, float64 without a copy: shape (n,), in "
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
          "Gradient of distance() at points of shape (n, 3): shape (n, 3). It is the gradient of the primitive whose "
          "value the tree takes, not normalised; outward on the surface.");
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
          "The surface as a closed TriangleMesh with sharp edges. Further keywords are fields of MeshingOptions. "
          "Unbounded solids are cut at a box around their primitives.")
      .def(
          "write",
          [](const Model& self, const std::filesystem::path& file, const std::optional<ExportOptions>& options,
             int threads, const py::object& progress) {
            return write_any(file, report_of(self, py::none(), file.stem().string()), options,
                             {.threads = threads, .progress = progress});
          },
          py::arg("file"), py::arg("options") = py::none(), py::kw_only(), py::arg("threads") = 0,
          py::arg("progress") = py::none(),
          "Writes a file by its ending: .json .scad .csg .FCMacro .py .step .stp .brep .stl .off .obj .3mf .dot .html "
          ".png. All but .json need a tree. Never leaves a partial file; does not overwrite a file of another kind. "
          "Returns ExportReport; raises Error.")
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
          "Picture of the solid in the colours of its primitives, with a cloud (PointCloud, or positions of shape (n, "
          "3)) on its left: red, green and blue, shape (height, width, 3), uint8. Further keywords are fields of "
          "PictureOptions.");
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
          "Text of an HTML page that shows the model and, with a cloud (PointCloud, or positions of shape (n, 3)), the "
          "distances between the two. The page needs no other files and no network. Raises Error in builds without the "
          "viewer.")
      .def(
          "_repr_html_",
          [](const Model& self) {
            return html_of(report_of(self, py::none(), {}), fmt::format("cloud2csg.Model: {}", summary_of(self)));
          },
          "The report for notebooks; a line of text if the model has no tree or this build no viewer.");
}

}  // namespace

void bind_models(py::module_& module) {
  bind_export_reports(module);
  ModelClass model(module, "Model",
                   "Primitives and, if known, the tree over them. Immutable.\n\nprimitives: iterable of Primitive, or "
                   "a Model. tree: a node of cloud2csg.tree, a text such as '(a | b) - c', or None. description: free "
                   "text.\n\nRaises Error for a repeated id, or an id in the tree that no primitive has.");
  bind_content(model);
  bind_texts(model);
  bind_fields(model);
  bind_outputs(model);
  bind_pages(model);
  module.def("has_viewer", &has_report_page, "Whether this build contains the report page.");
  module.def("has_brep", &has_brep, "Whether this build can write .step and .brep files.");
}

}  // namespace cloud2csg::python
