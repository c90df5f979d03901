#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <vector>

namespace cloud2csg::test {

/// Makes the vectorised kernels use one instruction set while it lives. Not for several at a time.
class ForcedTarget {
 public:
  explicit ForcedTarget(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~ForcedTarget() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;
  ForcedTarget(ForcedTarget&&) = delete;
  ForcedTarget& operator=(ForcedTarget&&) = delete;
};

/// Every instruction set that this machine has and this program was built for.
inline std::vector<std::int64_t> all_targets() {
  return hwy::SupportedAndGeneratedTargets();
}

}  // namespace cloud2csg::test
