#include <fmt/format.h>

#include <cctype>
#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"
#include "view/report/gather.hpp"
#include "view/report/page_template.hpp"
#include "view/report/payload.hpp"

namespace cloud2csg {
namespace {

/// Mark for the data in the page; equal to that in viewer/index.html.
constexpr std::string_view k_mark = "@CLOUD2CSG_REPORT@";

}  // namespace

std::optional<OptionConflict> conflict_in(const ReportOptions& options) {
  if (options.most_triangles_in_all >= options.most_triangles) return std::nullopt;
  return OptionConflict{"most_triangles_in_all", fmt::format("expected at least `most_triangles`, {}, found {}",
                                                             options.most_triangles, options.most_triangles_in_all)};
}

bool has_report_page() {
  return !page_template().empty();
}

std::string report_page(const Report& report, const ReportOptions& options, const RunContext& run) {
  validate(options);
  if (!report.model.tree) {
    throw Error({.where = "/tree", .expected = "expected a model with a tree, found primitives only"});
  }
  if (!has_report_page()) {
    throw Error({.expected = "this cloud2csg was built without the report page (.html)",
                 .remedy = "install Node.js 18 or later with npm, and build again with -DCLOUD2CSG_VIEWER=ON"});
  }
  const std::string_view page = page_template();
  const std::size_t mark = page.find(k_mark);
  if (mark == std::string_view::npos)
    throw Error({.where = "viewer", .expected = "the page has no place for the data"});
  std::string text(page.substr(0, mark));
  text += compressed_base64(gather_payload(report, options, run));
  text += page.substr(mark + k_mark.size());
  return text;
}

void write_report(const std::filesystem::path& file, const Report& report, const ReportOptions& options,
                  const RunContext& run) {
  write_text_file(file, report_page(report, options, run));
}

}  // namespace cloud2csg
