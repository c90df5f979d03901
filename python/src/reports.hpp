#pragma once

#include <optional>
#include <string>

#include "cloud2csg/view.hpp"
#include "run_work.hpp"

namespace cloud2csg::python {

/// The page in a frame for notebooks, or `text` without the viewer or without content. Names from the model cannot be
/// taken for HTML, and the page's scripts have no access to the notebook.
[[nodiscard]] std::string html_of(const Report& report, const std::string& text);

}  // namespace cloud2csg::python
