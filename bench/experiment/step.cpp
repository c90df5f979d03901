#include "bench/experiment/step.hpp"

#include <array>

namespace cloud2csg {
namespace {

constexpr std::array<Step, 7> k_steps{{{"segment", &StageSeconds::segment},
                                       {"overlap", &StageSeconds::overlap},
                                       {"partition", &StageSeconds::partition},
                                       {"classes", &StageSeconds::classes},
                                       {"search", &StageSeconds::search},
                                       {"merge", &StageSeconds::merge},
                                       {"simplify", &StageSeconds::simplify}}};

}  // namespace

std::span<const Step> extraction_steps() {
  return k_steps;
}

}  // namespace cloud2csg
