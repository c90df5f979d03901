#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>

#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/view.hpp"
#include "run_work.hpp"

namespace cloud2csg::python {

/// Primitives of a model, or of any iterable of primitives. @throws Error for a repeated id; TypeError
[[nodiscard]] PrimitiveSet to_primitives(const pybind11::object& primitives);

/// Writes the report for a file that ends in .html, else the model. @throws Error
[[nodiscard]] ExportReport write_any(const std::filesystem::path& file, const Report& report,
                                     const std::optional<ExportOptions>& options, const RunArguments& arguments);

/// "18 primitives, tree of 35 nodes"
[[nodiscard]] std::string summary_of(const Model& model);

}  // namespace cloud2csg::python
