#include "cloud2csg/advanced/option_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cloud2csg {
std::string range_text(const OptionRange& range, bool is_whole) {
  const bool has_least = range.least > std::numeric_limits<double>::lowest();
  const bool has_most = range.most < std::numeric_limits<double>::max();
  const std::string kind = range.takes_zero ? "0, or a" : "a";
  const std::string number = kind + (is_whole ? " whole number" : " number");
  if (has_least && has_most) {
    return range.is_above ? fmt::format("{} above {} and at most {}", number, range.least, range.most)
                          : fmt::format("{} from {} to {}", number, range.least, range.most);
  }
  if (has_least && range.is_above) return fmt::format("{} above {}", number, range.least);
  if (has_least) return fmt::format("{} of {} or more", number, range.least);
  if (has_most) return fmt::format("{} of {} or less", number, range.most);
  return is_whole ? number : "a finite number";
}

std::string range_fault(const OptionRange& range, double value, bool is_whole) {
  if (range.holds(value)) return {};
  const char* const bound = std::isinf(value) && value > range.least ? " and finite" : "";
  return fmt::format("expected {}{}, found {}", range_text(range, is_whole), bound, value);
}

std::string value_text(double value) {
  return fmt::format("{}", value);
}

std::string value_text(const Eigen::Vector3d& value) {
  return fmt::format("({}, {}, {})", value.x(), value.y(), value.z());
}

std::string option_name(const OptionField& field) {
  if (field.option == k_no_option) return {};
  if (!field.option.empty()) return std::string(field.option);
  std::string name(field.name);
  for (const std::string_view unit : {"_deg", "_seconds"}) {
    if (name.ends_with(unit)) name.resize(name.size() - unit.size());
  }
  std::ranges::replace(name, '_', '-');
  return name;
}

namespace options_detail {

void check_number(const std::string& path, const OptionRange& range, double value, bool is_whole) {
  std::string fault = range_fault(range, value, is_whole);
  if (!fault.empty()) throw invalid_option(path, std::move(fault));
}

}  // namespace options_detail
}  // namespace cloud2csg
