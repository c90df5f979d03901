#include "bindings.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/view.hpp"
#include "option_class.hpp"

namespace cloud2csg::python {

void bind_output_options(py::module_& module) {
  OptionClass<OpenScadOptions>(module, "OpenScadOptions", "How an OpenSCAD program is written.")
      .field("facets", &OpenScadOptions::facets, "How many facets a circle has ($fn; in .csg by $fa).")
      .field("mesh_resolution", &OpenScadOptions::mesh_resolution,
             "Of displaced and expression solids, which become polyhedra: cells along the longest side.")
      .field("patterns", &OpenScadOptions::patterns,
             ".scad: what repeats at equal steps or angles, or mirrored, as loops.")
      .field("comment", &OpenScadOptions::comment, "Lines for the head of the file, without '//'.")
      .finish();
  OptionClass<ScriptOptions>(module, "ScriptOptions", "How scripts in Python are written (.FCMacro, .py).")
      .field("facet_resolution", &ScriptOptions::facet_resolution,
             "Solids without exact surfaces are written with facets: so many cells along their longest side.")
      .field("comment", &ScriptOptions::comment, "Lines for the head of the file, without '#'.")
      .finish();
  OptionClass<BrepOptions>(module, "BrepOptions", "How exact solids are written (.step, .brep).")
      .field("name", &BrepOptions::name, "Of the part in the file; '': the name of the file without its ending.")
      .field("with_primitives", &BrepOptions::with_primitives,
             ".step: beside the solid, its primitives, each as a component with its name.")
      .field("facet_resolution", &BrepOptions::facet_resolution,
             "Solids without exact surfaces are written with facets: so many cells along their longest side.")
      .field("volume_tolerance", &BrepOptions::volume_tolerance,
             "The part of its volume by which a node may be wrong before its operation counts as failed.")
      .field("mesh_deviation", &BrepOptions::mesh_deviation,
             "Of meshes: how far triangles may be from the surface, as a part of the model's extent.")
      .finish();
  OptionClass<ExportOptions>(module, "ExportOptions", "How a model is written: see Model.write().")
      .nested("openscad", &ExportOptions::openscad, "Of .scad and .csg.")
      .nested("script", &ExportOptions::script, "Of .FCMacro and .py.")
      .nested("meshing", &ExportOptions::meshing, "Of .stl, .off, .obj and .3mf.")
      .nested("brep", &ExportOptions::brep, "Of .step, .stp and .brep.")
      .field("exact_meshes", &ExportOptions::exact_meshes,
             "Meshes of the exact solid where OpenCASCADE makes one, else by contouring in cells.")
      .finish();
  OptionClass<PictureOptions>(module, "PictureOptions", "How large a picture is, and from where: see Model.picture().")
      .field("width", &PictureOptions::width, "Pixels; 0: so many that each half is a square.")
      .field("height", &PictureOptions::height, "Pixels.")
      .field("azimuth_deg", &PictureOptions::azimuth_deg, "Of the camera, from the x axis towards y.")
      .field("elevation_deg", &PictureOptions::elevation_deg, "Of the camera, over the xy plane.")
      .field("resolution", &PictureOptions::resolution,
             "Cells along the longest side of the solid's mesh, of which only outlines show any.")
      .finish();
  OptionClass<ReportOptions>(module, "ReportOptions", "How large the page of a report is: see Model.report().")
      .field("most_points", &ReportOptions::most_points, "Points to show; of more, so many are taken.")
      .field("resolution", &ReportOptions::resolution, "Cells along the longest side of the whole solid's mesh.")
      .field("part_resolution", &ReportOptions::part_resolution, "... and of those of its parts.")
      .field("most_triangles", &ReportOptions::most_triangles, "Of the whole solid.")
      .field("most_triangles_in_all", &ReportOptions::most_triangles_in_all, "Of all meshes together.")
      .field("most_meshes", &ReportOptions::most_meshes, "Parts of the tree that have a mesh of their own.")
      .finish();
}

}  // namespace cloud2csg::python
