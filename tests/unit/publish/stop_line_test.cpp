#include "scree/publish/stop_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr StopSettings kZone{.length = 2, .width = 1, .hold = 0.5};

Obstacle box(double x, double y, double length, double width, double yaw = 0) {
  Obstacle obstacle;
  obstacle.center = {x, y, 0.2};
  obstacle.extent = {length, width, 0.4};
  obstacle.yaw = yaw;
  return obstacle;
}

bool is_in(const Obstacle& obstacle, const Pose& pose = {}) {
  return is_in_zone(kZone, pose, obstacle);
}

TEST(IsInZone, ReachesToTheEdgesOfTheZone) {
  EXPECT_TRUE(is_in(box(1, 0, 0.2, 0.2)));
  EXPECT_TRUE(is_in(box(2.09, 0, 0.2, 0.2)));
  EXPECT_FALSE(is_in(box(2.11, 0, 0.2, 0.2)));
  EXPECT_TRUE(is_in(box(1, 0.59, 0.2, 0.2)));
  EXPECT_FALSE(is_in(box(1, 0.61, 0.2, 0.2)));
  EXPECT_FALSE(is_in(box(1, -0.61, 0.2, 0.2)));
  EXPECT_TRUE(is_in(box(-0.09, 0, 0.2, 0.2)));
  EXPECT_FALSE(is_in(box(-0.11, 0, 0.2, 0.2)));
}

TEST(IsInZone, ATurnedBoxIsNotItsBounds) {
  // Its corner points at the zone's corner, or its side does.
  const double quarter = std::numbers::pi / 4;
  EXPECT_TRUE(is_in(box(2.3, 0, 0.5, 0.5, quarter)));
  EXPECT_FALSE(is_in(box(2.3, 0.8, 0.5, 0.5, quarter)));
  EXPECT_TRUE(is_in(box(2.2, 0.7, 4, 0.6, -quarter)));
  EXPECT_FALSE(is_in(box(2.3, 0.8, 4, 0.6, -quarter)));
  EXPECT_TRUE(is_in(box(1, 0, 20, 20, quarter)));  // the zone lies inside
}

TEST(IsInZone, TheZoneMovesWithTheRobot) {
  const Pose pose{{10, -5, 1}, from_roll_pitch_yaw(0, 0, std::numbers::pi / 2)};
  EXPECT_TRUE(is_in(box(10, -3.5, 0.2, 0.2), pose));
  EXPECT_FALSE(is_in(box(11.5, -5, 0.2, 0.2), pose));
  EXPECT_FALSE(is_in(box(1, 0, 0.2, 0.2), pose));
  // 0.4 m along the robot's way, 0.05 m across it.
  EXPECT_TRUE(is_in(box(10, -2.85, 0.4, 0.05, std::numbers::pi / 2), pose));
  EXPECT_FALSE(is_in(box(10, -2.85, 0.4, 0.05, 0), pose));
}

TEST(WillBeInZone, LooksAheadAsLongAsTheLineHolds) {
  Obstacle walker = box(1, 1.2, 0.2, 0.2);
  EXPECT_FALSE(will_be_in_zone(kZone, {}, walker));
  walker.velocity = {0, -1.3};
  EXPECT_TRUE(will_be_in_zone(kZone, {}, walker)) << "in 0.46 s";
  walker.velocity = {0, -1.1};
  EXPECT_FALSE(will_be_in_zone(kZone, {}, walker)) << "in 0.55 s";
  walker.velocity = {0, 2};
  EXPECT_FALSE(will_be_in_zone(kZone, {}, walker));
  walker.center.y() = 0;
  EXPECT_TRUE(will_be_in_zone(kZone, {}, walker)) << "now";
  walker.center.y() = 5;
  walker.velocity = {0, -15};
  EXPECT_TRUE(will_be_in_zone(kZone, {}, walker)) << "and out again";
}

/// Against points: a box overlaps the zone when one of many points of it lies inside.
TEST(IsInZone, AgreesWithPoints) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int inside = 0, outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose pose{{uniform(-5, 5), uniform(-5, 5), 0}, from_roll_pitch_yaw(0, 0, uniform(-3, 3))};
    const Eigen::Vector3d center = pose * Eigen::Vector3d(uniform(-2, 4), uniform(-2, 2), 0);
    const Obstacle obstacle =
        box(center.x(), center.y(), uniform(0.1, 1.5), uniform(0.1, 1.5), uniform(-1.5, 1.5));
    const auto holds_point = [&](double margin) {
      const Pose place{obstacle.center, from_roll_pitch_yaw(0, 0, obstacle.yaw)};
      for (int a = 0; a <= 60; ++a) {
        for (int b = 0; b <= 60; ++b) {
          const Eigen::Vector3d corner((a / 60.0 - 0.5) * obstacle.extent.x(),
                                       (b / 60.0 - 0.5) * obstacle.extent.y(), 0);
          const Eigen::Vector3d p = pose.rotation.conjugate() * (place * corner - pose.translation);
          if (p.x() > -margin && p.x() < 2 + margin && std::abs(p.y()) < 0.5 + margin) return true;
        }
      }
      return false;
    };
    if (holds_point(0)) {
      ++inside;
      EXPECT_TRUE(is_in(obstacle, pose)) << i;
    } else if (!holds_point(0.03)) {
      ++outside;
      EXPECT_FALSE(is_in(obstacle, pose)) << i;
    }
  }
  EXPECT_GT(inside, 400);
  EXPECT_GT(outside, 400);
}

TEST(IsInZone, AFootprintCountsInsteadOfTheBox) {
  Obstacle wall = box(2, 1, 3, 3);
  EXPECT_TRUE(is_in(wall));
  // A triangle whose long side cuts the box's corner in the zone off.
  for (const auto& [x, y] : {std::pair{3.5, -0.5}, {3.5, 2.5}, {0.5, 2.5}}) {
    wall.footprint.push_back({x, y});
  }
  EXPECT_FALSE(is_in(wall));
  const auto pose = [](double way, double yaw) {
    return Pose{{way, way, 0}, from_roll_pitch_yaw(0, 0, yaw)};
  };
  EXPECT_FALSE(is_in(wall, pose(0.1, 0)));
  EXPECT_TRUE(is_in(wall, pose(0.3, 0)));
  // Looking straight at the long side.
  EXPECT_FALSE(is_in(wall, pose(0, std::numbers::pi / 4)));
  EXPECT_TRUE(is_in(wall, pose(0.1, std::numbers::pi / 4)));
}

TEST(IsInZone, AnObstacleThatIsNowhereCounts) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_in(box(kNan, 0, 0.2, 0.2)));
  EXPECT_TRUE(is_in(box(9, 9, 0.2, 0.2, kNan)));
}

ObstacleList list_of(const std::vector<Obstacle>& obstacles) {
  ObstacleList list(8);
  for (const Obstacle& obstacle : obstacles) list.obstacles.push_back(obstacle);
  return list;
}

TEST(StopLine, BeginsBlindAndOn) {
  StopLine line(kZone);
  EXPECT_TRUE(line.is_on(0));
  line.update(list_of({}), 0);
  EXPECT_TRUE(line.is_on(9'000 * kMillisecond));
  line.set_blind(false, 9'000 * kMillisecond);
  EXPECT_TRUE(line.is_on(9'499 * kMillisecond));
  EXPECT_FALSE(line.is_on(9'500 * kMillisecond));
}

TEST(StopLine, IsOnWhileAnObstacleIsAheadAndHeldAfter) {
  StopLine line(kZone);
  line.set_blind(false, 0);
  std::int64_t now = 1'000 * kMillisecond;
  line.update(list_of({box(5, 0, 0.2, 0.2)}), now);
  EXPECT_FALSE(line.is_on(now));
  line.update(list_of({box(5, 0, 0.2, 0.2), box(1, 0, 0.2, 0.2)}), now += 100 * kMillisecond);
  EXPECT_TRUE(line.is_on(now));
  EXPECT_TRUE(line.is_on(now + 5'000 * kMillisecond));
  line.update(list_of({box(5, 0, 0.2, 0.2)}), now += 100 * kMillisecond);
  EXPECT_TRUE(line.is_on(now + 499 * kMillisecond));
  EXPECT_FALSE(line.is_on(now + 500 * kMillisecond));
  line.set_blind(true, now += 1'000 * kMillisecond);
  EXPECT_TRUE(line.is_on(now));
}

TEST(StopLine, WithoutHoldItFollowsAtOnce) {
  StopSettings settings = kZone;
  settings.hold = 0;
  StopLine line(settings);
  line.set_blind(false, 1);
  EXPECT_FALSE(line.is_on(1));
}

}  // namespace
}  // namespace scree
