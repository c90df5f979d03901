#include "reports.hpp"

#include <fmt/format.h>

#include "cloud2csg/error.hpp"

namespace cloud2csg::python {
namespace {

namespace py = pybind11;

/// In ASCII, so that it reads the same in a page of any encoding.
std::string escaped(const std::string& text) {
  const py::object safe = py::module_::import("html").attr("escape")(text, true);
  return safe.attr("encode")("ascii", "xmlcharrefreplace").cast<std::string>();
}

}  // namespace

std::string html_of(const Report& report, const std::string& text) {
  const auto as_text = [&](const std::string& reason) {
    return fmt::format("<pre>{}</pre>", escaped(reason.empty() ? text : text + "\n" + reason));
  };
  if (!report.model.tree) return as_text({});
  if (!has_report_page()) return as_text("(this build has no viewer, which needs Node.js at build time)");
  try {
    const std::string page = run_work({}, [&](const RunContext& run) { return report_page(report, {}, run); });
    return fmt::format(R"(<iframe srcdoc="{}" sandbox="allow-scripts allow-downloads" )"
                       R"(style="width: 100%; height: 640px; border: 0"></iframe>)",
                       escaped(page));
  } catch (const Error& error) {
    return as_text(error.what());
  }
}

}  // namespace cloud2csg::python
