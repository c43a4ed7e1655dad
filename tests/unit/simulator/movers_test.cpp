#include "simulator/movers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/drive.hpp"

namespace scree {
namespace {

CaptureSettings drive_with(MoverCounts movers, std::uint64_t seed) {
  CaptureSettings settings;
  settings.seed = seed;
  settings.scene = Scene::easy;
  settings.seconds = 6;
  settings.cell = 0.06;
  settings.margin = 15;
  settings.movers = movers;
  return settings;
}

TEST(Movers, KeepClearOfTheRobotOfThingsAndOfEachOther) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Drive drive(drive_with({.people = 4, .animals = 1, .vehicles = 1}, seed));
    EXPECT_GE(drive.movers.size(), 3U);
    for (std::int64_t t_ns = kDriveStartNs; t_ns < kDriveStartNs + 6'000'000'000;
         t_ns += 100'000'000) {
      const Eigen::Vector2d robot = drive.motion.base(t_ns).translation.head<2>();
      for (const Mover& mover : drive.movers) {
        const Eigen::Vector2d at = place_at(mover.track, t_ns).position;
        EXPECT_GT((at - robot).norm(), 1.1 + mover.radius);
        const int feature = drive.terrain.feature_at(at.x(), at.y());
        if (feature == 0) continue;
        const TerrainFeature& hit = drive.terrain.features()[static_cast<std::size_t>(feature) - 1];
        EXPECT_TRUE(hit.is_small || !hit.kind) << hit.name;
      }
    }
  }
}

TEST(Movers, TheSameSeedGivesTheSameOnesAndNoneChangeNothingElse) {
  const Drive one(drive_with({.people = 3}, 5)), same(drive_with({.people = 3}, 5));
  const Drive none(drive_with({}, 5));
  ASSERT_EQ(one.movers.size(), same.movers.size());
  EXPECT_EQ(one.movers[0].track.back().position, same.movers[0].track.back().position);
  EXPECT_TRUE(none.movers.empty());
  EXPECT_EQ(one.terrain.features().size(), none.terrain.features().size());
  EXPECT_EQ(one.motion.base(kDriveStartNs + 5'000'000'000).translation,
            none.motion.base(kDriveStartNs + 5'000'000'000).translation);
}

TEST(Movers, TheTruthMovesWithThemAndAsksForThoseThatAreSeen) {
  const Drive drive(drive_with({.people = 5}, 7));
  DriveFeed feed(drive);
  SyncBuffer sensors;
  std::size_t asked = 0;
  const int first = static_cast<int>(drive.terrain.features().size()) + 1;
  for (Sweep sweep(1 << 15); feed.next(sweep, {&sensors}); sensors.gather()) {
    const Truth::Sight& sight = feed.truth().visible.back();
    for (const int id : sight.ids) {
      if (id < first) continue;
      ++asked;
      const auto& obstacle =
          feed.truth().obstacles[feed.truth().obstacles.size() - drive.movers.size() +
                                 static_cast<std::size_t>(id - first)];
      EXPECT_EQ(obstacle.id, id);
      EXPECT_EQ(obstacle.shape, "person");
      const Pose base = drive.motion.base(sight.t_ns);
      const Eigen::Vector3d there = base.inverse() * obstacle.at(sight.t_ns).center;
      EXPECT_LT(there.head<2>().norm(), 8.3);
      EXPECT_GT(there.x(), 0.3);
    }
  }
  EXPECT_GT(asked, 20U);
}

}  // namespace
}  // namespace scree
