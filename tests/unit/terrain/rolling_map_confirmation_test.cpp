#include "scree/core/random.hpp"
#include "terrain/rolling_map_fixture.hpp"

namespace scree {
namespace {

using RollingMapConfirmation = test::RollingMapFixture;

TEST_F(RollingMapConfirmation, APointThatNoOtherSweepConfirmsStaysOutAndGoes) {
  const Eigen::Vector3d noise(3, 1, 1.5), twice(3, -1, 1.5), beside(3, 4, 1.5), dust(3, -4, 1.5);
  const Eigen::Vector3d right(kVoxel, 0, 0), up(0, 0, kVoxel);
  see(noise);
  see(twice);
  see(beside);
  see(dust);
  end_sweep();
  EXPECT_EQ(map_.cloud().size(), 0U);
  EXPECT_EQ(map_.voxels(), 4U);
  wait(10);
  see(twice);
  see(beside + right);
  see(dust + right);
  end_sweep();
  see(beside + up);
  end_sweep();
  EXPECT_FALSE(has_near(noise));
  EXPECT_TRUE(has_near(twice));
  EXPECT_TRUE(has_near(beside)) << "three sweeps";
  EXPECT_FALSE(has_near(dust)) << "two grains beside one another";
  EXPECT_EQ(map_.voxels(), 7U);
  wait(60);
  EXPECT_EQ(map_.voxels(), 4U) << "noise and dust are gone";
  EXPECT_TRUE(has_near(twice));
  EXPECT_TRUE(has_near(beside));
}

TEST_F(RollingMapConfirmation, ASweepConfirmsWithASurfaceThatTwoHaveSeen) {
  const Eigen::Vector3d surface(3, 0, 0.5), right(kVoxel, 0, 0);
  for (int i = 0; i < 2; ++i) {
    see(surface);
    end_sweep();
  }
  see(surface + right);
  end_sweep();
  EXPECT_TRUE(has_near(surface + right));
}

TEST_F(RollingMapConfirmation, GrainsDoNotConfirmOneAnother) {
  const Eigen::Vector3d right(kVoxel, 0, 0), up(0, 0, kVoxel);
  const Eigen::Vector3d dust(3, 1, 1.5), again(3, -1, 1.5), blade(3, 4, 1.5), grass(3, -4, 1.5);
  for (int sweep = 0; sweep < 4; ++sweep) {
    see(dust + (sweep & 1) * right + (sweep >> 1) * up, true);
    if (sweep < 2) see(again, true);
    if (sweep < 3) see(blade, true);
    see(grass + (sweep & 1) * right + (sweep >> 1) * up, sweep == 0);
    end_sweep();
  }
  EXPECT_FALSE(has_near(dust, 0.1)) << "four grains beside one another";
  EXPECT_FALSE(has_near(again)) << "two grains in the same place";
  EXPECT_TRUE(has_near(blade)) << "three sweeps have seen it";
  EXPECT_TRUE(has_near(grass + right)) << "three that are no grains";
  EXPECT_FALSE(has_near(grass)) << "a grain among them";
}

TEST_F(RollingMapConfirmation, DustWhereNearlyAllBeamsGoThroughStaysOut) {
  const Eigen::Vector3d lidar(0, 0, 1), wire(4, 2, 1.36), dust(4, -2, 1.36), tip(4, 0, 1.36);
  const Eigen::Vector3d right(0, 0.02, 0), up(0, 0, 0.02);
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (int column = -5; column <= 5; ++column) {
      see(wire + column * right);
      for (int row = -8; row <= 5; ++row) {
        const Eigen::Vector3d off = column * right + row * up;
        for (const Eigen::Vector3d& place : {wire, dust, tip}) {
          if (place != wire || row != 0) see_nothing(place + off - lidar);
        }
      }
      for (int row = 8; row <= 13; ++row) see(tip + column * right - row * up);
    }
    if (sweep > 16) {
      see(dust);
      see(tip);
    }
    end_sweep();
  }
  EXPECT_TRUE(has_near(wire));
  EXPECT_FALSE(has_near(dust, 0.1)) << "three sweeps have seen it, but few beams";
  EXPECT_TRUE(has_near(tip)) << "it stands on what most beams end at";
  for (int sweep = 0; sweep < 5; ++sweep) {
    see(dust);
    end_sweep();
  }
  EXPECT_TRUE(has_near(dust)) << "eight have seen it there: it is none";
}

TEST_F(RollingMapConfirmation, APuffThatStopsOneBeamInFourteenStaysOut) {
  const Eigen::Vector3d lidar(0, 0, 1), right(0, 0.02, 0), up(0, 0, 0.02), puff(4.03, 0.13, 1.38);
  Random random(3);
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (int column = -5; column <= 5; ++column) {
      for (int row = -5; row <= 5; ++row) {
        const Eigen::Vector3d place = puff + column * right + row * up;
        if (random.index(14) == 0) {
          see(place + Eigen::Vector3d(random.uniform(0, 0.2), 0, 0));
        } else {
          see_nothing(place - lidar);
        }
      }
    }
    end_sweep();
  }
  EXPECT_GT(map_.voxels(), 20U) << "there is something to keep out";
  EXPECT_EQ(map_.cloud().size(), 0U);
}

TEST_F(RollingMapConfirmation, PointsOfOneSweepDoNotConfirmOneAnother) {
  for (int i = 0; i < 10; ++i) see({3 + kVoxel * i, 0, 1.5});
  end_sweep();
  EXPECT_EQ(map_.cloud().size(), 0U);
}

// After hours of standing still, too: counts do not wrap.
TEST_F(RollingMapConfirmation, StaysConfirmedHoweverOftenItIsSeen) {
  map_ = RollingMap({.voxel = kVoxel, .reach = 12}, 16);
  for (int i = 0; i < 140'000; ++i) {
    see({3, 0, 0});
    end_sweep();
    ASSERT_EQ(map_.cloud().size(), i > 0 ? 1U : 0U) << i;
  }
}

}  // namespace
}  // namespace scree
