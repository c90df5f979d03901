#include "bindings.hpp"

namespace c2c = cloud2csg::python;

PYBIND11_MODULE(_native, module) {
  module.doc() = "The compiled part of cloud2csg. The package exports its names.";
  module.attr("__version__") = CLOUD2CSG_VERSION;
  c2c::bind_errors(module);
  c2c::bind_options(module);
  c2c::bind_clouds(module);
  c2c::bind_primitives(module);
  c2c::bind_models(module);
  c2c::bind_synth(module);
  c2c::bind_compare(module);
  c2c::bind_detect(module);
  c2c::bind_extract(module);
}
