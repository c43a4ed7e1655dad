#include "scree/terrain/rolling_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "allocation_counter.hpp"
#include "scree/core/rotation.hpp"
#include "terrain/rolling_map_fixture.hpp"

namespace scree {
namespace {

using RollingMapTest = test::RollingMapFixture;

constexpr int kPruned = 2 * RollingMap::kPruneSweeps;  // sweeps

using Cell = std::tuple<int, int, int>;

Cell cell_of(const Eigen::Vector3d& place) {
  const auto cell = [](double value) {
    return static_cast<int>(std::floor(value / RollingMapTest::kVoxel));
  };
  return {cell(place.x()), cell(place.y()), cell(place.z())};
}

TEST_F(RollingMapTest, KeepsTheMeanOfEachVoxelsPoints) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> jitter(-0.02, 0.02);
  pose_ = {{1, -2, 0.3}, from_roll_pitch_yaw(0.05, -0.1, 2)};
  std::map<Cell, std::vector<Eigen::Vector3d>> reference;
  for (int sweep = 0; sweep < 9; ++sweep) {
    for (int x = -40; x < 40; ++x) {
      for (int y = -40; y < 40; y += 2) {
        for (int again = 0; again < 1 + (x & 3); ++again) {
          const Eigen::Vector3d point(kVoxel * (x + 0.5) + jitter(random),
                                      kVoxel * (y + 0.5) + jitter(random), 0.025 + jitter(random));
          see(point);
          reference[cell_of(point)].push_back(point);
        }
      }
    }
    end_sweep();
  }
  ASSERT_EQ(map_.voxels(), reference.size());
  ASSERT_EQ(map_.cloud().size(), reference.size());
  EXPECT_EQ(map_.dropped(), 0U);
  for (std::size_t i = 0; i < map_.cloud().size(); ++i) {
    const auto& points = reference.at(cell_of(confirmed(i)));
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
    ASSERT_LT((confirmed(i) - mean).norm(), 1e-5);
    ASSERT_EQ(map_.cloud().reflectivity[i], 20);
  }
}

TEST_F(RollingMapTest, ASweepsReachIsKept) {
  pose_ = {{-1, 2, 0}, from_roll_pitch_yaw(0, 0, 1)};
  const Eigen::Vector3d near(1, 2, 0), far(4, 2, 0);
  for (const double reach : {4.0, 6.0}) {
    for (int sweep = 0; sweep < 3; ++sweep) {
      see(near);
      see(far);
      end_sweep(reach);
    }
    EXPECT_TRUE(has_near(near));
    EXPECT_EQ(has_near(far), reach > 5);
  }
  // What stands farther off than a sweep reaches is not seen through either.
  for (int sweep = 0; sweep < 50; ++sweep) {
    see({9, 2, -0.8});
    end_sweep(4);
  }
  EXPECT_TRUE(has_near(far));
}

TEST_F(RollingMapTest, WhatIsFarIsGatheredAndHandedOutOnceItIsNear) {
  settings_.reach = 18;
  settings_.search_reach = 12;
  map_ = RollingMap(settings_, kMaxVoxels);
  const Eigen::Vector3d far(15, 0, 0.5), too_far(19, 0, 0.5);
  for (int i = 0; i < 3; ++i) {
    see(far);
    see(too_far);
    end_sweep();
  }
  EXPECT_EQ(map_.voxels(), 1U);
  EXPECT_EQ(map_.cloud().size(), 0U);
  pose_.translation.x() = 4;
  end_sweep();
  ASSERT_EQ(map_.cloud().size(), 1U);
  EXPECT_TRUE(has_near(far));
  EXPECT_EQ(map_.beams()[0].ended, 3) << "of the beams from afar";
}

TEST_F(RollingMapTest, ForgetsWhatIsFarOrOld) {
  const Eigen::Vector3d left(0, 0, 0), right(11, 0, 0);
  for (int i = 0; i < 2; ++i) {
    see(left);
    see(right);
    end_sweep();
  }
  pose_.translation.x() = 11.5;
  wait(kPruned);
  EXPECT_TRUE(has_near(left));
  pose_.translation.x() = 12.5;
  wait(kPruned);
  EXPECT_FALSE(has_near(left));
  EXPECT_TRUE(has_near(right));
  EXPECT_EQ(map_.voxels(), 1U);
  now_ns_ += 54'000'000'000;
  wait(kPruned);
  EXPECT_TRUE(has_near(right));
  now_ns_ += 4'000'000'000;
  wait(kPruned);
  EXPECT_EQ(map_.voxels(), 0U);

  see({400, 0, 0});
  end_sweep();
  EXPECT_EQ(map_.voxels(), 0U) << "too far to be taken";
}

TEST_F(RollingMapTest, BuildsUpAnewWhenTheClockIsSet) {
  const Eigen::Vector3d there(3, 0, 0), gone(3, 3, 0);
  constexpr std::int64_t kHour = 3'600'000'000'000;
  for (const std::int64_t shift : {-400'000 * kHour, 800'000 * kHour, -kHour}) {
    for (int i = 0; i < 3; ++i) {
      see(there);
      see(gone);
      end_sweep();
    }
    now_ns_ += shift;
    for (int i = 0; i < kPruned; ++i) {
      see(there);
      end_sweep();
    }
    EXPECT_TRUE(has_near(there));
    EXPECT_FALSE(has_near(gone));
  }
}

TEST_F(RollingMapTest, CountsTheBeamsThatEndedInAVoxelAndThoseThatPassedIt) {
  const Eigen::Vector3d lidar(0, 0, 1), place(3.02, 0.02, 0.035);
  const auto along = (place - lidar).normalized();
  const Eigen::Vector3d beside(0, 0.03, 0), below(0, 0, -0.012);
  const auto beams_of = [&](std::size_t sweeps, const Eigen::Vector3d& farther) {
    map_ = RollingMap(settings_, kMaxVoxels);
    for (std::size_t i = 0; i < sweeps; ++i) {
      see(place);
      see(farther);
      end_sweep();
    }
    for (std::size_t i = 0; i < map_.cloud().size(); ++i) {
      if ((confirmed(i) - place).norm() < 0.01) return map_.beams()[i];
    }
    ADD_FAILURE() << "the place is not in the map";
    return BeamCount();
  };
  // One beam of four is followed, and counts for four, and for four more that passed above.
  const BeamCount through = beams_of(40, place + 0.5 * along + below);
  EXPECT_EQ(through.ended, 40);
  EXPECT_EQ(through.passed, 80);
  EXPECT_NEAR(through.scatter, 40 * kScatter, 1e-4);
  EXPECT_EQ(beams_of(40, place + 0.5 * along - below).passed, 0) << "over it, as over a rock";
  EXPECT_EQ(beams_of(40, place + 0.08 * along + below).passed, 0) << "on the same surface";
  EXPECT_EQ(beams_of(40, place + 0.5 * along + below + beside).passed, 0) << "past it";
  // However long the robot has been there.
  const BeamCount after_minutes = beams_of(3'000, place + 0.5 * along + below);
  const BeamCount after_hours = beams_of(100'000, place + 0.5 * along + below);
  EXPECT_GT(after_minutes.ended, 400);
  EXPECT_NEAR(after_hours.ended / after_minutes.ended, 1, 0.2);
  EXPECT_NEAR(after_hours.passed / after_hours.ended, 2, 1e-3) << "both fade alike";
  EXPECT_NEAR(after_hours.scatter / after_hours.ended, kScatter, 1e-4);
}

TEST_F(RollingMapTest, DropsAndCountsWhatFindsNoRoomAndRecovers) {
  map_ = RollingMap({.voxel = kVoxel, .reach = 7}, 500);
  const auto look = [&](double x) {
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 2000; ++k)
        see({x + 0.1 * (k % 50) + 0.024, 0.1 * (k / 50) - 1.976, 0.024});
      end_sweep();
    }
  };
  look(0);
  EXPECT_EQ(map_.voxels(), 500U);
  EXPECT_EQ(map_.cloud().size(), 500U);
  EXPECT_EQ(map_.dropped(), 3000U);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_NEAR(confirmed(i).z(), 0.024, 1e-6);
  pose_.translation.x() = 20;
  wait(kPruned);
  EXPECT_EQ(map_.voxels(), 0U);
  look(20);
  EXPECT_EQ(map_.cloud().size(), 500U);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_GT(confirmed(i).x(), 19);
}

// Kilometres each way, with a grid of points in the world that is the same for all sweeps.
TEST_F(RollingMapTest, FollowsTheRobotOverKilometres) {
  const Eigen::Vector3d ways[] = {{2, 0, 0}, {-2, 1.1, 0.2}};
  for (const Eigen::Vector3d& way : ways) {
    map_ = RollingMap(settings_, kMaxVoxels);
    pose_ = Pose();
    for (int sweep = 0; sweep < 2000; ++sweep) {
      pose_.translation += way;
      pose_.rotation = exponential({0, 0, 0.01 * sweep});
      const Eigen::Vector3d middle = pose_.translation.array().round();
      for (int x = -5; x <= 5; ++x) {
        for (int y = -5; y <= 5; ++y) {
          const Eigen::Vector3d point = middle + Eigen::Vector3d(x + 0.02, y - 0.03, 0.024);
          see(point);
        }
      }
      end_sweep();
      ASSERT_LT((map_.origin() - pose_.translation).cwiseAbs().maxCoeff(), 30);
      ASSERT_LT(map_.voxels(), 121U * 14);
      if (sweep % 50 != 49) continue;
      ASSERT_GT(map_.cloud().size(), 80U) << sweep;
      for (std::size_t i = 0; i < map_.cloud().size(); ++i) {
        const Eigen::Vector3d point = confirmed(i) - Eigen::Vector3d(0.02, -0.03, 0.024);
        const Eigen::Vector3d rounded = point.array().round();
        ASSERT_LT((point - rounded).norm(), 2e-3) << sweep;
      }
      EXPECT_EQ(map_.occupancy_at(middle + Eigen::Vector3d(0.02, -0.03, 0.024)),
                Occupancy::occupied);
      // Halfway between the lidar and each point; only some of the beams are followed.
      const Eigen::Vector3d lidar = pose_.translation + Eigen::Vector3d::UnitZ();
      int empty = 0;
      for (int k = 0; k < 121; ++k) {
        const Eigen::Vector3d point = middle + Eigen::Vector3d(k % 11 - 5, k / 11 - 5, 0);
        empty += map_.occupancy_at(0.5 * (lidar + point)) == Occupancy::free ? 1 : 0;
      }
      EXPECT_GT(empty, 10) << sweep;
      EXPECT_EQ(map_.occupancy_at(middle - Eigen::Vector3d(0, 0, 1.5)), Occupancy::unknown);
    }
  }
}

TEST_F(RollingMapTest, TakesEmptySweepsAndPointsAtTheLidarItself) {
  end_sweep();
  see({0, 0, 1});
  end_sweep();
  end_sweep();
  EXPECT_LE(map_.voxels(), 1U);
  map_.clear();
  EXPECT_EQ(map_.voxels(), 0U);
  EXPECT_EQ(map_.cloud().size(), 0U);
  EXPECT_EQ(map_.occupancy_at({0, 0, 1}), Occupancy::unknown);
}

TEST_F(RollingMapTest, AllocatesNothing) {
  const std::size_t before = test::allocations();
  for (int i = 0; i < 50; ++i) {
    pose_.translation.x() = i;
    for (int k = 0; k < 1000; ++k) see({i + 0.01 * k, 0.1 * (k % 7), 0});
    end_sweep();
  }
  EXPECT_EQ(test::allocations(), before);
}

TEST_F(RollingMapTest, WhatBeamsIntoTheSkyPassIsForgotten) {
  const Eigen::Vector3d lidar(0, 0, 1), gone(3, 1, 1.4), low(3, -1, 0.6);
  for (int i = 0; i < 10; ++i) {
    see(gone);
    see(low);
    end_sweep();
  }
  EXPECT_TRUE(has_near(gone) && has_near(low));
  for (int i = 0; i < 40; ++i) {
    see_nothing(gone - lidar);
    see_nothing(low - lidar);
    end_sweep();
  }
  EXPECT_FALSE(has_near(gone));
  EXPECT_EQ(map_.occupancy_at(gone), Occupancy::free);
  EXPECT_TRUE(has_near(low)) << "a beam lost on its way down may have met dark ground";
}

}  // namespace
}  // namespace scree
