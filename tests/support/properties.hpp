#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace cloud2csg::test {

/// In a property, RapidCheck is to see that an expectation failed, so that it looks for a smaller case.
inline void fail_property_when_failed() {
  RC_ASSERT(!::testing::Test::HasFailure());
}

}  // namespace cloud2csg::test
