#include "simulator/visibility.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

/// A terrain with a rock and a hole among others, and shots on one of them at will.
class Sights : public testing::Test {
protected:
  Sights() : terrain_(settings(), 2), visibility_(terrain_) {}

  static TerrainSettings settings() {
    TerrainSettings settings;
    settings.size = 24;
    settings.cell = 0.05;
    settings.placed_within = 12;
    settings.small = 3;
    return settings;
  }

  const TerrainFeature& feature(ObstacleKind kind, bool is_small = false) const {
    return *std::find_if(terrain_.features().begin(), terrain_.features().end(),
                         [&](const TerrainFeature& feature) {
                           return feature.kind == kind && feature.is_small == is_small;
                         });
  }

  void sweep(const TerrainFeature& on, int shots, double share_of_height) {
    for (int i = 0; i < shots; ++i) {
      SimulatedShot shot;
      shot.range = 5;
      shot.part = static_cast<std::uint16_t>(on.first_part);
      shot.relief = static_cast<float>(share_of_height * on.height);
      visibility_.add(std::span(&shot, 1));
    }
    visibility_.end_sweep();
  }

  /// `base` this far from a feature, which lies straight ahead.
  static Pose before(const TerrainFeature& feature, double distance) {
    return {feature.center - Eigen::Vector3d(distance, 0, 0), Eigen::Quaterniond::Identity()};
  }

  bool asks(const TerrainFeature& feature, const Pose& base) const {
    const auto [ids, ignore] = visibility_.asked_for(base);
    const auto has = [&](const std::vector<int>& list) {
      return std::find(list.begin(), list.end(), feature.id) != list.end();
    };
    EXPECT_NE(has(ids), has(ignore));
    return has(ids);
  }

  Terrain terrain_;
  Visibility visibility_;
};

TEST_F(Sights, ARockCountsAfterEnoughShotsOfSeveralSweeps) {
  const TerrainFeature& rock = feature(ObstacleKind::positive);
  const Pose base = before(rock, 5);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(asks(rock, base));
    sweep(rock, 30, 0.5);
  }
  EXPECT_TRUE(asks(rock, base));
}

TEST_F(Sights, OnlyAheadAndWithinTenMetres) {
  const TerrainFeature& rock = feature(ObstacleKind::positive);
  for (int i = 0; i < 3; ++i) sweep(rock, 30, 0.5);
  EXPECT_TRUE(asks(rock, before(rock, 9.9)));
  EXPECT_FALSE(asks(rock, before(rock, 10.1)));
  EXPECT_FALSE(asks(rock, before(rock, 0.4)));
  EXPECT_FALSE(asks(rock, before(rock, -3)));
}

TEST_F(Sights, AHolesBrinkIsNotEnough) {
  const TerrainFeature& hole = feature(ObstacleKind::negative);
  for (int i = 0; i < 5; ++i) sweep(hole, 50, 0.2);
  EXPECT_FALSE(asks(hole, before(hole, 4)));
  sweep(hole, 1, 0.5);
  EXPECT_TRUE(asks(hole, before(hole, 4)));
}

TEST_F(Sights, StonesAreNeverAskedFor) {
  const bool is_stone =
      std::any_of(terrain_.features().begin(), terrain_.features().end(), [](const auto& feature) {
        return feature.is_small && feature.kind == ObstacleKind::positive;
      });
  ASSERT_TRUE(is_stone);
  const TerrainFeature& stone = feature(ObstacleKind::positive, true);
  for (int i = 0; i < 5; ++i) sweep(stone, 50, 0.9);
  EXPECT_FALSE(asks(stone, before(stone, 4)));
}

}  // namespace
}  // namespace scree
