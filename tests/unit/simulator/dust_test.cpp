#include "simulator/dust.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "simulator/bare_terrain.hpp"
#include "simulator/lidar.hpp"

namespace scree {
namespace {

constexpr std::int64_t kStart = 1'598'612'520'000'000'000, kSecond = 1'000'000'000;
constexpr double kPuffs = 10;

/// Along x at 1 m/s for five seconds; then the robot stands.
Motion drive() {
  std::vector<Pose> knots;
  for (int i = 0; i <= 50; ++i) knots.push_back({{0.1 * i, 0, 0}, Eigen::Quaterniond::Identity()});
  return {std::move(knots), kStart, kSecond / 10};
}

/// The share of beams along the way, 0.2 to 0.6 m above the ground, that meet a grain at most 12 m
/// off.
double met(Dust& dust, std::int64_t t_ns) {
  int met = 0, beams = 0;
  for (double y = -0.6; y <= 0.6; y += 0.05) {
    for (double z = 0.2; z <= 0.6; z += 0.05) {
      ++beams;
      const auto range = dust.cast({-6, y, z}, Eigen::Vector3d::UnitX(), t_ns, 12);
      if (!range) continue;
      EXPECT_GT(*range, 0);
      EXPECT_LT(*range, 12);
      ++met;
    }
  }
  return static_cast<double>(met) / beams;
}

TEST(Dust, ComesWhileTheRobotDrivesAndGoes) {
  const Motion motion = drive();
  Dust dust(kPuffs, motion, kStart, 3);
  EXPECT_EQ(met(dust, kStart), 0) << "it has not driven yet";
  std::int64_t t_ns = kStart;
  while (t_ns < kStart + 3 * kSecond) dust.advance(t_ns += kSecond / 100);
  const double driving = met(dust, t_ns);
  EXPECT_GT(driving, 0.05);
  EXPECT_LT(driving, 0.9);
  while (t_ns < kStart + 8 * kSecond) dust.advance(t_ns += kSecond / 100);
  EXPECT_LT(met(dust, t_ns), driving) << "settles while the robot stands";
  while (t_ns < kStart + 11 * kSecond) dust.advance(t_ns += kSecond / 100);
  EXPECT_EQ(met(dust, t_ns), 0);
}

TEST(Dust, WithoutPuffsThereIsNone) {
  const Motion motion = drive();
  Dust dust(0, motion, kStart, 3);
  dust.advance(kStart + 3 * kSecond);
  EXPECT_EQ(met(dust, kStart + 3 * kSecond), 0);
}

TEST(Dust, AsManyPuffsHoweverOftenItIsAsked) {
  const Motion motion = drive();
  const auto after = [&](std::int64_t step_ns) {
    Dust dust(kPuffs, motion, kStart, 3);
    for (std::int64_t t_ns = kStart; t_ns <= kStart + 3 * kSecond; t_ns += step_ns) {
      dust.advance(t_ns);
    }
    return met(dust, kStart + 3 * kSecond);
  };
  EXPECT_NEAR(after(kSecond / 1000), after(kSecond / 100), 0.1);
}

TEST(Dust, HidesWhatLiesBehindItFromTheLidar) {
  const Terrain terrain(test::bare_terrain(30), 1);
  const RayCaster caster(terrain);
  const Motion motion = drive();
  const Pose mount{{0.1, 0, 0.95}, from_roll_pitch_yaw(0, 0.1, 0)};
  SimulatedLidarSettings clear;
  clear.lost_share = 0;
  SimulatedLidarSettings dusty = clear;
  dusty.dust_puffs = kPuffs;
  SimulatedLidar without(terrain, caster, clear, motion, mount, kStart, 1);
  SimulatedLidar with(terrain, caster, dusty, motion, mount, kStart, 1);
  int nearer = 0, farther = 0, shots = 0;
  while (with.packet_ns() < kStart + 3 * kSecond) {
    with.advance();
    without.advance();
    for (std::size_t i = 0; i < with.shots().size(); ++i) {
      ++shots;
      const float range = with.shots()[i].range, behind = without.shots()[i].range;
      if (range == 0 || behind == 0) continue;
      if (range < behind - 0.3F) ++nearer;
      if (range > behind + 0.3F) ++farther;
    }
  }
  EXPECT_GT(nearer, 1e-4 * shots);
  EXPECT_LT(nearer, 0.01 * shots);
  // Along the ground far off the noise is as large.
  EXPECT_LT(farther, 0.1 * nearer);
}

}  // namespace
}  // namespace scree
