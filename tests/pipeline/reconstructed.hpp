#pragma once

#include "cloud2csg/reconstruct.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg::test {

/// How right a reconstruction is: intersection over union with the truth.
inline double iou(const Extraction& result, const Model& truth) {
  return membership_iou(result.model, truth, 50);
}

}  // namespace cloud2csg::test
