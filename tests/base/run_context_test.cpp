#include "cloud2csg/run_context.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

TEST(RunContext, ThrowsOnlyAfterTheStop) {
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token()};
  EXPECT_NO_THROW(run.throw_if_stopped());
  stop.request_stop();
  EXPECT_THROW(run.throw_if_stopped(), Cancelled);
}

TEST(RunContext, PassesProgressOn) {
  std::vector<std::string> stages;
  std::size_t done = 0;
  const RunContext run{.on_progress = [&](const Progress& progress) {
    stages.emplace_back(progress.stage);
    done = progress.done;
  }};
  run.report("read", 5, 10);
  EXPECT_EQ(stages, std::vector<std::string>{"read"});
  EXPECT_EQ(done, 5U);
}

TEST(RunContext, IsSilentWithoutListener) {
  EXPECT_NO_THROW(RunContext{}.report("read", 1, 2));
}

}  // namespace
}  // namespace cloud2csg
