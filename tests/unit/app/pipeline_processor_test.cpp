#include "app/pipeline_processor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "terrain/rough_ground.hpp"

namespace scree {
namespace {

Settings map_settings() {
  Settings settings;
  settings.lidar = test::usual_lidar();
  settings.memory.sweep_points = 1 << 13;
  settings.memory.map_voxels = 1 << 16;
  return settings;
}

class PipelineProcessorTest : public testing::Test {
protected:
  const ObstacleList* process(const Sweep& sweep) { return processor_(sweep, report_); }
  static Sweep row_of_points(int points) {
    Sweep sweep(static_cast<std::size_t>(points));
    for (int i = 1; i <= points; ++i) sweep.push_back({static_cast<float>(i), 0, 0}, 7, 0, 0);
    return sweep;
  }

  Settings settings_ = map_settings();
  Pipeline pipeline_{settings_, Networks()};
  PipelineProcessor processor_{pipeline_, settings_.track};
  DetectionReport report_;
};

TEST_F(PipelineProcessorTest, SumsUpWhatWasDroppedSweepBySweep) {
  settings_.memory.sweep_points = 3;
  Pipeline small(settings_, Networks());
  PipelineProcessor processor(small, settings_.track);
  EXPECT_NE(processor(row_of_points(5), report_), nullptr);
  EXPECT_EQ(report_.drops.points, 2U);
  processor(row_of_points(6), report_);
  EXPECT_EQ(report_.drops.points, 5U);
  EXPECT_EQ(processor(row_of_points(7), report_), nullptr) << "most has found no room";
  EXPECT_EQ(report_.drops.points, 9U);
}

TEST_F(PipelineProcessorTest, GivesNoListOfASweepThatIsNotAWholeTurn) {
  Sweep sweep = row_of_points(2);
  sweep.is_whole = false;
  EXPECT_EQ(process(sweep), nullptr);
}

TEST_F(PipelineProcessorTest, KnowsHowWellThePoseIsKnownOnlyWithAMap) {
  process(row_of_points(2));
  EXPECT_TRUE(std::isnan(report_.motion.position_deviation));
  EXPECT_TRUE(std::isnan(report_.motion.yaw_deviation));
  const test::SimpleDrive drive = test::helix(1, 0.2, 0);
  drive.put_imu(pipeline_.sensors(), 0, 1);
  drive.put_wheel(pipeline_.sensors(), 0, 1);
  Sweep sweep(1 << 13);
  for (const double end : {0.2, 0.3, 0.4}) {
    test::scan(test::RoughGround(), drive, settings_.lidar, end, sweep);
    process(sweep);
  }
  EXPECT_GT(report_.motion.position_deviation, 0);
  EXPECT_GT(report_.motion.yaw_deviation, 0);
}

}  // namespace
}  // namespace scree
