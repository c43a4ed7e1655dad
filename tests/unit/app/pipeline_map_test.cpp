#include <gtest/gtest.h>

#include <set>

#include "allocation_counter.hpp"
#include "driven_pipeline.hpp"

namespace scree {
namespace {

struct SlowPipelineMap : PipelineMap {
  using PipelineMap::go;
  void TestBody() override {}
};

/// Every edge is an obstacle.
class PipelineMapOfEdges : public PipelineMap {
protected:
  PipelineMapOfEdges() : PipelineMap(all_edges()) {}

  static Settings all_edges() {
    Settings settings = small_settings();
    settings.map.registration = false;
    settings.detect_sweep.min_confidence = 0;
    settings.detect_sweep.edges.threshold = 0.1;
    settings.detect_sweep.edges.min_block_points = 1;
    settings.detect_sweep.edges.min_cluster_size = 1;
    settings.track.appear = settings.track.disappear = 0;
    return settings;
  }
};

TEST_F(PipelineMap, PutsTheGroundTogetherByTheLidarAlone) {
  ground_.roughness = 1.5;
  const Pose reported = go(20, false).pose, begin = drive_.base(kSweep * sweeps_);
  const ObstacleList& list = go(30, false);
  EXPECT_TRUE(pipeline_.uses_map());
  EXPECT_GT(pipeline_.ground().size(), 1000U);
  const Pose moved = test::relative(reported, list.pose);
  const Pose truth = test::relative(begin, drive_.base(kSweep * sweeps_));
  EXPECT_GT(truth.translation.norm(), 2.5);
  EXPECT_LT((moved.translation - truth.translation).norm(), 0.05);
}

/// odom is one frame from the first pose on.
TEST_F(PipelineMap, GoesOnInTheSameFrameWhenAMotionSensorSpeaks) {
  ground_.roughness = 1.5;
  const Pose before = go(20, false).pose, begin = drive_.base(kSweep * sweeps_);
  EXPECT_TRUE(pipeline_.uses_map());
  const Pose first = test::relative(before, go(1).pose);
  EXPECT_TRUE(pipeline_.uses_map());
  const Pose truth = test::relative(begin, drive_.base(kSweep * sweeps_));
  EXPECT_LT((first.translation - truth.translation).norm(), 0.02);
  EXPECT_NEAR(yaw_of(first.rotation), yaw_of(truth.rotation), 0.005);
  const ObstacleList& list = go(10);
  EXPECT_EQ(list.stamp_ns, sweep_.end_ns);
  const Pose pose = pipeline_.mapper().to_odom() * pipeline_.mapper().pose();
  EXPECT_EQ(list.pose.translation, pose.translation);
  const Pose moved = test::relative(before, list.pose);
  const Pose true_way = test::relative(begin, drive_.base(kSweep * sweeps_));
  EXPECT_GT(true_way.translation.norm(), 1);
  EXPECT_LT((moved.translation - true_way.translation).norm(), 0.05);
  EXPECT_GT(pipeline_.ground().size(), 1000U);
  EXPECT_EQ(&pipeline_.ground(), &pipeline_.mapper().map().cloud());
  go(2, false);
  EXPECT_TRUE(pipeline_.uses_map()) << "also when they fall silent";
}

/// As when a capture is played in a loop.
TEST_F(PipelineMap, BeginsAnewWhereLidarAndImuStartOverTogether) {
  const Pose once = go(20).pose;
  lidar_starts_over_ = imu_starts_over_ = true;
  drive_again();
  const Pose again = go(20).pose;
  EXPECT_LT((again.translation - once.translation).norm(), 0.02);
  EXPECT_LT(again.rotation.angularDistance(once.rotation), 0.005);
}

TEST_F(PipelineMap, GoesOnWhereTheLidarAloneStartsOver) {
  go(20);
  lidar_starts_over_ = true;
  const Pose pose = go(20).pose;
  EXPECT_NEAR(pose.translation.norm(), drive_.base(4).translation.norm(), 0.15);
}

class PipelineMapWithoutRegistration : public PipelineMap {
protected:
  PipelineMapWithoutRegistration() : PipelineMap(without()) {}
  static Settings without() {
    Settings settings = small_settings();
    settings.map.registration = false;
    return settings;
  }
};

TEST_F(PipelineMapWithoutRegistration, TakesSweepsByThemselvesUntilAMotionSensorSpeaks) {
  const ObstacleList& alone = go(2, false);
  EXPECT_FALSE(pipeline_.uses_map());
  EXPECT_EQ(alone.pose.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(pipeline_.ground().size(), sweep_.points.size());
  go(10);
  EXPECT_TRUE(pipeline_.uses_map());
}

TEST_F(PipelineMap, TakesSweepsByThemselvesWhereTheGroundDoesNotShowTheWay) {
  ground_.roughness = 0;
  go(20, false);
  EXPECT_FALSE(pipeline_.uses_map());
  EXPECT_EQ(go(1, false).pose.translation, Eigen::Vector3d::Zero());
  EXPECT_TRUE(pipeline_.has_looked());
}

TEST_F(PipelineMapOfEdges, AnObstacleOfSweepsByThemselvesKeepsItsId) {
  std::set<std::int64_t> before, all;
  const auto ids_of = [](const ObstacleList& list) {
    std::set<std::int64_t> ids;
    for (const Obstacle& obstacle : list.obstacles) ids.insert(obstacle.id);
    return ids;
  };
  std::size_t stayed = 0, found = 0;
  for (int i = 0; i < 10; ++i) {
    const ObstacleList& list = go(1, false);
    ASSERT_FALSE(list.obstacles.empty());
    const std::set<std::int64_t> ids = ids_of(list);
    EXPECT_EQ(ids.size(), list.obstacles.size());
    for (const std::int64_t id : ids) stayed += before.contains(id) ? 1U : 0U;
    if (i > 0) found += ids.size();
    all.insert(ids.begin(), ids.end());
    before = ids;
  }
  EXPECT_GT(stayed, found / 2);
  const std::set<std::int64_t> ids_in_map = ids_of(go(10));
  ASSERT_FALSE(ids_in_map.empty());
  EXPECT_GT(*ids_in_map.begin(), *all.rbegin()) << "what the map has is another obstacle";
}

// Registration keeps the map as the first attitude laid it; what is published is upright.
/// A processor that is too slow leaves out sweeps.
TEST_F(PipelineMap, SweepsThatAreLeftOutCostNoPlace) {
  const Pose all = go(60).pose;
  for (const int every : {2, 4}) {
    SCOPED_TRACE(every);
    SlowPipelineMap some;
    some.go(1);  // odom begins with it
    const Pose pose = some.go(59, true, every).pose;
    EXPECT_LT((pose.translation - all.translation).norm(), 0.03);
    EXPECT_LT(pose.rotation.angularDistance(all.rotation), 0.005);
  }
}

TEST_F(PipelineMap, PublishesPosesThatStandUpright) {
  drive_.lean = exponential({0.008, -0.006, 0});
  const auto lean_of = [&](const Pose& pose) {
    const Eigen::Quaterniond truth = drive_.base(kSweep * sweeps_).rotation;
    const Eigen::Vector3d up = pose.rotation * truth.conjugate() * Eigen::Vector3d::UnitZ();
    return up.head<2>().norm();
  };
  EXPECT_NEAR(lean_of(go(1).pose), 0.01, 0.001);
  const Pose published = go(60).pose;
  EXPECT_NEAR(lean_of(pipeline_.mapper().pose()), 0.01, 0.002);
  EXPECT_LT(lean_of(published), 0.004);
}

TEST_F(PipelineMap, HasNotLookedWithItsFirstSweepNorWithAPartOfATurn) {
  go(1, false);
  EXPECT_TRUE(pipeline_.has_looked()) << "a sweep by itself";
  go(1);
  EXPECT_TRUE(pipeline_.ground().empty()) << "no second sweep has confirmed a point";
  EXPECT_FALSE(pipeline_.has_looked());
  go(1);
  EXPECT_TRUE(pipeline_.has_looked());
  sweep_.is_whole = false;
  go(1);
  EXPECT_FALSE(pipeline_.has_looked());
}

TEST_F(PipelineMap, TheGridOfAListIsAroundTheRobotAndSaysWhatWasSeen) {
  go(1, false);
  EXPECT_EQ(pipeline_.grid(), nullptr) << "a sweep by itself";
  const ObstacleList& list = go(20);
  const ObstacleGrid* grid = pipeline_.grid();
  ASSERT_NE(grid, nullptr);
  EXPECT_EQ(grid->stamp_ns, list.stamp_ns);
  EXPECT_EQ(grid->pose.translation, list.pose.translation);
  EXPECT_EQ(grid->columns, 120U) << "map.search_reach to each side";
  const Eigen::Vector2d middle = grid->middle(59, 59) + Eigen::Vector2d(0.1, 0.1);
  EXPECT_LT((middle - list.pose.translation.head<2>()).cwiseAbs().maxCoeff(), 0.11);
  const auto free = std::ranges::count(grid->state, CellState::free);
  EXPECT_GT(free, 500);
  EXPECT_LT(free, 120 * 120 / 2) << "between the rings";
  EXPECT_EQ(grid->state[0], CellState::unknown) << "a corner is out of reach";
  for (std::size_t cell = 0; cell < grid->cells(); ++cell) {
    if (grid->state[cell] != CellState::free) continue;
    const Eigen::Vector2d middle_of_cell = grid->middle(cell % 120, cell / 120);
    const double z = grid->pose.translation.z() + 0.01 * grid->ground[cell];
    const Eigen::Vector3d in_odom(middle_of_cell.x(), middle_of_cell.y(), z);
    const Eigen::Vector3d place = drive_.base(kSweep * sweeps_) * (grid->pose.inverse() * in_odom);
    EXPECT_NEAR(place.z(), ground_.height(place.x(), place.y()), 0.1);
  }
}

TEST_F(PipelineMap, TimesTheStagesThatRun) {
  const auto time_of = [&](Stage stage) {
    return pipeline_.stage_times()[static_cast<std::size_t>(stage)];
  };
  go(2);
  EXPECT_EQ(time_of(Stage::map), kDidNotRun);
  static std::int64_t reading = 0;
  pipeline_.time_stages([] { return ++reading; });
  go(1);
  for (const Stage stage :
       {Stage::motion, Stage::registration, Stage::map, Stage::voxel_grid, Stage::gradient,
        Stage::clusters, Stage::network, Stage::tracking, Stage::grid}) {
    EXPECT_EQ(time_of(stage), 1) << kStageNames[static_cast<std::size_t>(stage)];
  }
}

TEST_F(PipelineMap, NothingIsAllocatedAfterTheStart) {
  const std::size_t before = test::allocations();
  go(3, false);
  go(10);
  go(4, false);
  shift_ns_ = -3'600'000'000'000;
  go(5);
  sweep_.clear();
  sweep_.end_ns = test::nanoseconds(kSweep * sweeps_ + 0.01) + shift_ns_;
  pipeline_.process(sweep_);
  go(2);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(pipeline_.counts().voxels, 1000U);
}

TEST_F(PipelineMap, GoesOnWhenTheClockIsSet) {
  go(12);
  for (const std::int64_t hours : {1, 500'000, -500'001, -400'000}) {
    shift_ns_ += hours * 3'600'000'000'000;
    const ObstacleList& list = go(8);
    EXPECT_EQ(list.stamp_ns, sweep_.end_ns);
    const Eigen::Vector3d truth = drive_.base(kSweep * sweeps_).translation;
    EXPECT_NEAR(list.pose.translation.norm(), truth.norm(), 0.3) << hours;
    EXPECT_GT(pipeline_.ground().size(), 1000U) << hours;
  }
}

class PipelineMapWithoutGrid : public PipelineMap {
protected:
  PipelineMapWithoutGrid() : PipelineMap(without()) {}
  static Settings without() {
    Settings settings = small_settings();
    settings.lcm.grid = false;
    return settings;
  }
};

TEST_F(PipelineMapWithoutGrid, MakesNone) {
  go(5);
  EXPECT_EQ(pipeline_.grid(), nullptr);
}

class PipelineMapTooSmall : public PipelineMap {
protected:
  PipelineMapTooSmall() : PipelineMap(few_points()) {}
  static Settings few_points() {
    Settings settings = small_settings();
    settings.memory.sweep_points = 1000;
    return settings;
  }
};

TEST_F(PipelineMapTooSmall, CountsThePointsThatItsMemoryDoesNotHold) {
  go(3);
  EXPECT_EQ(pipeline_.mapper().sweep().points.size(), 1000U);
  EXPECT_EQ(pipeline_.counts().dropped, sweep_.points.size() - 1000);
}

TEST_F(PipelineMapTooSmall, HasNotLookedWhereMostPointsFoundNoRoom) {
  go(3);
  EXPECT_GT(sweep_.points.size(), 2000U);
  EXPECT_FALSE(pipeline_.has_looked());
}

// A second robot of the same kind sees the very same, to the last bit.
TEST(PipelineMapAgain, GivesTheSameListsOnEveryRun) {
  Settings settings = small_settings();
  settings.track.appear = settings.track.disappear = 0.3;  // the network has learnt nothing
  const test::SimpleDrive drive = test::helix(1, 0.2, 0);
  std::vector<std::vector<double>> runs(2);
  for (std::vector<double>& values : runs) {
    Pipeline pipeline(settings, Networks());
    Sweep sweep(1 << 13);
    drive.put_imu(pipeline.sensors(), 0, 1.2);
    drive.put_wheel(pipeline.sensors(), 0, 1.2);
    for (int i = 1; i <= 10; ++i) {
      test::scan(test::RoughGround(), drive, settings.lidar, kSweep * i, sweep);
      const ObstacleList& list = pipeline.process(sweep);
      values.insert(values.end(), {list.pose.translation.x(), list.pose.rotation.z()});
      for (const Obstacle& obstacle : list.obstacles) {
        values.insert(values.end(),
                      {static_cast<double>(obstacle.id), obstacle.center.x(), obstacle.center.y(),
                       static_cast<double>(obstacle.confidence), obstacle.height});
      }
    }
  }
  EXPECT_GT(runs[0].size(), 20U) << "some obstacles are needed to compare";
  EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace scree
