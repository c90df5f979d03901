#pragma once

#include <pybind11/pybind11.h>

/// The Python module, one file per concept. Names, defaults and units are the library's; see docs/python.md.
namespace cloud2csg::python {

namespace py = pybind11;

// Each adds its classes and functions to the module; later ones use classes of earlier ones.
void bind_errors(py::module_& module);
void bind_options(py::module_& module);
void bind_clouds(py::module_& module);
void bind_primitives(py::module_& module);
void bind_models(py::module_& module);
void bind_synth(py::module_& module);
void bind_compare(py::module_& module);
void bind_detect(py::module_& module);
void bind_extract(py::module_& module);

}  // namespace cloud2csg::python
