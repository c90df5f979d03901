#pragma once

#include <string>
#include <vector>

#include "cloud2csg/extract.hpp"

namespace cloud2csg::bench {

struct Setting {
  std::string name;
  ExtractOptions options;
};

/// All settings, the default first. New ones appear in all tables.
[[nodiscard]] inline std::vector<Setting> all_settings() {
  return {
      {"auto", {}},
      {"paper", paper_options()},
      {"baseline", {.strategy = Strategy::baseline}},
  };
}

}  // namespace cloud2csg::bench
