#pragma once

#include <string>
#include <vector>

#include "cloud2csg/extract.hpp"

namespace cloud2csg::bench {

/// A way to extract that is measured.
struct Setting {
  std::string name;
  ExtractOptions options;
};

/// All, the default first. Add one here, and all tables have it.
[[nodiscard]] inline std::vector<Setting> all_settings() {
  return {
      {"auto", {}},
      {"paper", paper_options()},
      {"baseline", {.strategy = Strategy::baseline}},
  };
}

}  // namespace cloud2csg::bench
