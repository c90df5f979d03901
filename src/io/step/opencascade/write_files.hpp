#pragma once

#include <TopoDS_Shape.hxx>

#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

struct NamedShape {
  TopoDS_Shape shape;
  std::string name;
};

/// One part with named faces, or an assembly of the part and a group of components.
struct StepContent {
  NamedShape part;
  std::vector<NamedShape> faces;  ///< the part's faces
  std::vector<NamedShape> components = {};
  std::string assembly_name = {};
  std::string program = {};  ///< program that writes the file
};

/// Names must be ASCII without quotes, backslashes and control characters. @throws Standard_Failure, std::runtime_error
void write_step_file(const std::filesystem::path& file, const StepContent& content);

/// The content of a STEP file according to the kernel's own reader.
struct StepReading {
  bool is_valid = false;
  double volume = 0;
  std::size_t solids = 0;
};
/// @throws Standard_Failure
[[nodiscard]] StepReading read_step_file(const std::filesystem::path& file);

/// @throws Standard_Failure, std::runtime_error
void write_brep_file(const std::filesystem::path& file, const TopoDS_Shape& shape);

}  // namespace cloud2csg::brep
