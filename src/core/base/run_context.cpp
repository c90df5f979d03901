#include "cloud2csg/run_context.hpp"

#include "cloud2csg/error.hpp"

namespace cloud2csg {

void RunContext::throw_if_stopped() const {
  if (stop.stop_requested()) throw Cancelled();
}

void RunContext::report(std::string_view stage, std::size_t done, std::size_t total, std::string_view unit) const {
  if (on_progress) on_progress({.stage = stage, .done = done, .total = total, .unit = unit});
}

}  // namespace cloud2csg
