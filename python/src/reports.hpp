#pragma once

#include <optional>
#include <string>

#include "cloud2csg/view.hpp"
#include "run_work.hpp"

namespace cloud2csg::python {

/// The page as a frame of its own for notebooks; in builds without the viewer, or where there is nothing to show, the
/// text. Names that come with the model cannot be taken for HTML, and scripts of the page see nothing of the notebook.
[[nodiscard]] std::string html_of(const Report& report, const std::string& text);

}  // namespace cloud2csg::python
