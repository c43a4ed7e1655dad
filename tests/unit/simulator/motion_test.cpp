#include "simulator/motion.hpp"

#include <gtest/gtest.h>

#include "simulator/bare_terrain.hpp"
#include "simulator/body.hpp"

namespace scree {
namespace {

TEST(Motion, IsStraightBetweenItsKnotsAndStandsOutsideThem) {
  const Pose a{{0, 0, 0}, Eigen::Quaterniond::Identity()};
  const Pose b{{1, 0, 0}, from_roll_pitch_yaw(0, 0, 0.2)};
  const Motion motion({a, b}, 1000, 100);
  EXPECT_NEAR(motion.base(1050).translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(motion.base(1050).rotation.angularDistance(from_roll_pitch_yaw(0, 0, 0.1)), 0, 1e-6);
  EXPECT_EQ(motion.base(0).translation.x(), 0);
  EXPECT_EQ(motion.base(5000).translation.x(), 1);
  EXPECT_NEAR(motion.distance(1050), 0.5 * std::cos(0.2), 1e-9);
  EXPECT_EQ(Motion(a).base(123).translation, a.translation);
}

TEST(Track, IsSmoothAndStaysNear) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto track = draw_track({30, 0}, seed);
    constexpr double kStep = static_cast<double>(kTrackStepNs) * 1e-9;
    double driven = 0;
    for (std::size_t i = 1; i < track.size(); ++i) {
      const double moved = (track[i].position - track[i - 1].position).norm();
      driven += moved;
      EXPECT_LE(track[i].speed, 2.0);
      EXPECT_GE(track[i].speed, 0);
      EXPECT_NEAR(moved, track[i - 1].speed * kStep, 1e-5);
      EXPECT_LT(std::abs(track[i].speed - track[i - 1].speed) / kStep, 4);
      EXPECT_LT(std::abs(track[i].yaw - track[i - 1].yaw) / kStep, 1.0);
      ASSERT_LT(track[i].position.norm(), 15) << "seed " << seed;
    }
    EXPECT_GT(driven, 30 * 0.3);
    EXPECT_GT(std::abs(track.back().yaw - track.front().yaw), 1e-3);
  }
}

TEST(Track, DrivesBackwardsForAStretchIfAsked) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto track = draw_track({.seconds = 20, .reverse = true}, seed);
    double back = 0, on = 0;
    int turns = 0;
    for (std::size_t i = 1; i < track.size(); ++i) {
      const TrackPoint &before = track[i - 1], &here = track[i];
      const Eigen::Vector2d ahead(std::cos(before.yaw), std::sin(before.yaw));
      const double moved = (here.position - before.position).dot(ahead);
      EXPECT_NEAR(moved * 1e9 / kTrackStepNs, before.speed, 1e-3) << i;
      (moved < 0 ? back : on) += std::abs(moved);
      turns += (here.speed < 0) != (before.speed < 0) ? 1 : 0;
      EXPECT_LT(std::abs(here.speed - before.speed), 0.01);
      ASSERT_LT(here.position.norm(), 20) << "seed " << seed;
    }
    EXPECT_EQ(turns, 2) << "seed " << seed;
    EXPECT_GT(back, 0.3) << "seed " << seed;
    EXPECT_GT(on, back);
  }
}

TEST(Body, DrivesBackwardsAsTheTrackSays) {
  TerrainSettings settings = test::bare_terrain(50);
  settings.cell = 0.05;
  const Terrain terrain(settings, 2);
  const auto track = draw_track({.seconds = 20, .reverse = true}, 4);
  const Motion motion = follow_ground(track, terrain, draw_body(2), 0, 2);
  for (std::size_t i = 10; i < track.size(); i += 10) {
    const auto t_ns = static_cast<std::int64_t>(i) * kTrackStepNs;
    const double moved = motion.distance(t_ns) - motion.distance(t_ns - 10 * kTrackStepNs);
    if (track[i].speed < -0.1) {
      EXPECT_LT(moved, 0) << i;
    }
    if (track[i].speed > 0.1) {
      EXPECT_GT(moved, 0) << i;
    }
  }
}

TEST(Track, DrivesAsFastAsAsked) {
  const auto track = draw_track({40, 1.2}, 3);
  double sum = 0;
  for (const TrackPoint& point : track) sum += point.speed;
  EXPECT_NEAR(sum / static_cast<double>(track.size()), 1.2, 0.25);
}

TEST(Body, FollowsTheGround) {
  TerrainSettings settings = test::bare_terrain(40);
  settings.cell = 0.05;
  settings.roughness = 0;
  settings.gentlest_slope_deg = settings.steepest_slope_deg = 12;
  const Terrain terrain(settings, 2);
  const auto track = draw_track({15, 1}, 2);
  const Motion motion = follow_ground(track, terrain, draw_body(2), 0, 2);
  double steepest = 0;
  double shaken = 0;
  for (std::int64_t t = 0; t < 15'000'000'000; t += 50'000'000) {
    const Pose base = motion.base(t);
    const double ground = terrain.height(base.translation.x(), base.translation.y());
    EXPECT_NEAR(base.translation.z(), ground, 0.03);
    const Eigen::Vector3d normal = terrain.normal(base.translation.x(), base.translation.y());
    const Eigen::Vector3d up = base.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT(std::acos(std::min(normal.dot(up), 1.0)), 0.08);
    steepest = std::max(steepest, std::acos(up.z()));
    const Pose next = motion.base(t + 10'000'000);
    shaken = std::max(shaken, base.rotation.angularDistance(next.rotation));
  }
  EXPECT_GT(steepest, 0.02);
  EXPECT_GT(shaken, 0.001);
}

}  // namespace
}  // namespace scree
