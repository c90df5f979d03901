#include <gtest/gtest.h>

#include <map>
#include <string>

#include "cloud2csg/advanced/prepare.hpp"
#include "prepare/clouds.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

struct Told {
  std::size_t count = 0;
  std::size_t done = 0;
  std::size_t restarts = 0;
};

/// What each stage tells: always points, never more than there are, nor fewer than before unless it begins anew.
class Listener {
 public:
  explicit Listener(std::size_t points, std::size_t restarts = 0) : points_(points), restarts_(restarts) {}

  void operator()(const Progress& progress) {
    Told& told = told_[std::string(progress.stage)];
    EXPECT_EQ(progress.unit, "points") << progress.stage;
    EXPECT_EQ(progress.total, points_) << progress.stage;
    if (progress.done < told.done) ++told.restarts;
    EXPECT_LE(told.restarts, restarts_) << progress.stage;
    EXPECT_LE(progress.done, points_) << progress.stage;
    ++told.count;
    told.done = progress.done;
  }

  void expect_all_done(const std::string& stage) const {
    ASSERT_TRUE(told_.contains(stage)) << stage;
    EXPECT_EQ(told_.at(stage).done, points_) << stage;
    EXPECT_GT(told_.at(stage).count, 4U) << stage;
  }

 private:
  std::size_t points_;
  std::size_t restarts_;
  std::map<std::string, Told> told_ = {};
};

TEST(PrepareProgress, CleaningTellsHowManyPointsAreDone) {
  for (const bool has_duplicate : {false, true}) {
    PointCloud raw = model_cloud("m0", 20'000, 0.002);
    raw.normals = {};
    // Then it is not prepared in one go.
    if (has_duplicate) raw.positions.push_back(raw.positions[0]);
    Listener listener(raw.size(), has_duplicate ? 1 : 0);
    const RunContext run{.on_progress =
                             [&](const Progress& p) {
                               if (p.stage != "normals") listener(p);
                             },
                         .threads = 2};
    static_cast<void>(prepare_cloud(raw, {}, run));
    listener.expect_all_done("clean");
  }
}

TEST(PrepareProgress, NormalsTellToo) {
  PointCloud cloud = model_cloud("m0", 20'000, 0.002);
  for (const bool has_sensors : {false, true}) {
    if (has_sensors) {
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        cloud.sensor_positions.push_back(cloud.positions[i] + 10.0 * cloud.normals[i]);
      }
    }
    Listener listener(cloud.size());
    const RunContext run{.on_progress = [&](const Progress& p) { listener(p); }, .threads = 2};
    static_cast<void>(estimate_normals(cloud, estimate_scale(cloud), run));
    listener.expect_all_done("normals");
  }
}

}  // namespace
}  // namespace cloud2csg
