#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <utility>

#include "bindings.hpp"
#include "cloud2csg/error.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg::python {
namespace {

/// Translators are stateless functions, so this looks up the module's class.
void raise(const Error& error) {
  const py::object type = py::module_::import("cloud2csg._native").attr("Error");
  const py::object raised = type(error.what());
  raised.attr("file") = error.parts().file;
  raised.attr("where") = error.parts().where;
  raised.attr("expected") = error.parts().expected;
  raised.attr("remedy") = error.parts().remedy;
  raised.attr("warnings") = py::tuple(py::cast(error.parts().warnings));
  PyErr_SetObject(type.ptr(), raised.ptr());
}

/// The function that takes a file of this kind, to suggest it in place of another.
const char* taker_of(FileKind kind) {
  switch (kind) {
    case FileKind::cloud:
      return "read it with read_cloud()";
    case FileKind::mesh:
      return "read it with read_mesh(), or draw points from it with read_cloud()";
    case FileKind::model:
      return "read it with Model.read()";
    default:
      return "no function reads it";
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  py::dict members;
  members["__module__"] = "cloud2csg";
  members["__doc__"] =
      "Bad input: a file, an option or a model that the library cannot work with.\n\nstr() is one line. file, where "
      "(line, byte or path of the field), expected and remedy are its parts; parts that do not apply are ''. Where no "
      "solid was found, warnings are sentences about doubts before that.";
  for (const char* part : {"file", "where", "expected", "remedy"}) members[part] = "";
  members["warnings"] = py::tuple();
  module.attr("Error") = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&PyType_Type))(
      "Error", py::make_tuple(py::reinterpret_borrow<py::object>(PyExc_Exception)), members);
  py::register_local_exception_translator([](std::exception_ptr pending) {
    try {
      if (pending) std::rethrow_exception(std::move(pending));
    } catch (const WrongFile& error) {
      Error::Parts parts = error.parts();
      parts.remedy = taker_of(error.found());
      raise(Error(std::move(parts)));
    } catch (const Error& error) {
      raise(error);
    } catch (const Cancelled& cancelled) {
      PyErr_SetString(PyExc_KeyboardInterrupt, cancelled.what());
    }
  });
}

}  // namespace cloud2csg::python
