#include "pipeline/time_limit.hpp"

#include <gtest/gtest.h>

namespace cloud2csg {
namespace {

TEST(TimeLimit, ThatIsOverIsEnforcedAtOnce) {
  const TimeLimit limit({}, 1e-9);
  limit.enforce();
  EXPECT_TRUE(limit.token().stop_requested());
}

TEST(TimeLimit, ThatIsNotOverStopsNothing) {
  for (const double seconds : {3600.0, 1e300}) {
    const TimeLimit limit({}, seconds);
    limit.enforce();
    EXPECT_FALSE(limit.token().stop_requested()) << seconds;
  }
  const TimeLimit none({}, std::nullopt);
  none.enforce();
  EXPECT_FALSE(none.token().stop_requested());
}

TEST(TimeLimit, PassesOnWhatTheCallerStops) {
  std::stop_source caller;
  const TimeLimit limit(caller.get_token(), 3600.0);
  EXPECT_FALSE(limit.token().stop_requested());
  caller.request_stop();
  EXPECT_TRUE(limit.token().stop_requested());
}

}  // namespace
}  // namespace cloud2csg
