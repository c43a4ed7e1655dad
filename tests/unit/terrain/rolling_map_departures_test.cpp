#include <algorithm>
#include <random>
#include <vector>

#include "terrain/rolling_map_fixture.hpp"

namespace scree {
namespace {

class RollingMapDeparturesTest : public test::RollingMapFixture {
protected:
  /// Sees one column of points at each of these places, one after the other, a sweep each.
  void see_columns(const std::vector<double>& ys) {
    for (const double y : ys) {
      for (double z = 0.4; z < 1.3; z += 0.3) see({8, y, z});
      for (double z = 0.4; z < 1.3; z += 0.3) see({8.06, y, z});
      end_sweep();
    }
  }
  /// Where someone is who walks at 0.5 m/s.
  static std::vector<double> walk() {
    std::vector<double> ys;
    for (int i = 0; i < 12; ++i) ys.push_back(0.05 * i + 0.02);
    return ys;
  }
  /// A box around all of that.
  static Obstacle around_all() {
    Obstacle obstacle;
    obstacle.center = {8.03, 0.3, 0.65};
    obstacle.extent = {0.1, 0.6, 1.3};
    obstacle.height = 1.3;
    return obstacle;
  }
};

TEST_F(RollingMapDeparturesTest, WhatIsLeftOfSomeoneWhoWentGoesVoxelByVoxel) {
  const auto see_someone = [this] {
    for (double z = 0.3; z < 1.5; z += 0.04) see({4.01, 0, z});
  };
  const auto see_wall = [this] {
    for (int i = 0; i < 400; ++i) {
      const double share = i / 400.0;    // the wall's height that a beam over the place meets
      see({8, 0.2, 2.4 * share - 0.4});  // beams go past 0.1 m beside
    }
  };
  // A corner of its box lies in cells where nothing was ever hit.
  Obstacle standing;
  standing.center = {3.99, 0, 0.8};
  standing.extent = {0.12, 0.06, 1.4};
  standing.height = 1.4;
  for (int i = 0; i < 6; ++i) {
    see_someone();
    see_wall();
    end_sweep();
    EXPECT_FALSE(map_.remove_left(standing, true)) << "still there";
  }
  for (int i = 0; i < 4; ++i) {
    see_wall();
    end_sweep();
  }
  EXPECT_TRUE(has_near({4.01, 0, 0.9}, 0.1));
  EXPECT_FALSE(map_.remove_left(standing));
  EXPECT_TRUE(map_.remove_left(standing, true));
  EXPECT_TRUE(has_near({4.01, 0, 0.9}, 0.1));
  map_.update_cloud();
  EXPECT_FALSE(has_near({4.01, 0, 0.9}, 0.5));
}

/// No beam goes through where they were any more, as between the lidar's rings.
TEST_F(RollingMapDeparturesTest, TheTrailOfSomeoneWhoWalksGoesAndHeStays) {
  see_columns(walk());
  ASSERT_TRUE(has_near({8, 0.2, 0.7}, 0.1));
  EXPECT_FALSE(map_.remove_trail(around_all())) << "he is there";
  map_.update_cloud();
  EXPECT_FALSE(has_near({8, 0.2, 0.7}, 0.1));
  EXPECT_TRUE(has_near({8, 0.47, 0.7}, 0.1));
}

TEST_F(RollingMapDeparturesTest, TheTrailOfSomeoneOutOfSightGoesAsAWhole) {
  see_columns(walk());
  wait(5);
  EXPECT_FALSE(map_.remove_left(around_all(), true));
  EXPECT_TRUE(map_.remove_trail(around_all()));
  map_.update_cloud();
  EXPECT_TRUE(map_.cloud().empty());
}

TEST_F(RollingMapDeparturesTest, WhatIsSeenInNoOrderStays) {
  std::vector<double> ys = walk();
  std::mt19937 random(3);
  std::ranges::shuffle(ys, random);
  see_columns(ys);
  wait(5);
  EXPECT_FALSE(map_.remove_trail(around_all()));
}

/// The robot drives past: what stands is lost from sight bit by bit, and was seen often before.
TEST_F(RollingMapDeparturesTest, WhatWasSeenOftenStays) {
  const std::vector<double> ys = walk();
  for (int i = 0; i < 3; ++i) see_columns(ys);
  wait(5);
  EXPECT_FALSE(map_.remove_trail(around_all()));
}

TEST_F(RollingMapDeparturesTest, WhatIsLowOrFarFasterThanAnythingStays) {
  see_columns(walk());
  wait(5);
  Obstacle low = around_all();
  low.height = 0.3;
  EXPECT_FALSE(map_.remove_trail(low));
  map_.clear();
  std::vector<double> ys;
  for (int i = 0; i < 12; ++i) ys.push_back(0.9 * i);
  see_columns(ys);
  wait(5);
  Obstacle fast = around_all();
  fast.center.y() = 5;
  fast.extent.y() = 10;
  EXPECT_FALSE(map_.remove_trail(fast));
}

}  // namespace
}  // namespace scree
