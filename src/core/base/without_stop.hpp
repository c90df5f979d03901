#pragma once

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// For short work that an interrupted search needs as well: its tree has a fit, too, and what searches after it sees
/// the stop.
[[nodiscard]] inline RunContext without_stop(RunContext run) {
  run.stop = {};
  return run;
}

}  // namespace cloud2csg
