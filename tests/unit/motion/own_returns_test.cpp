#include "scree/motion/own_returns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace scree {
namespace {

constexpr double kHeightOfLidar = 0.9;
constexpr float kStepLength = 0.08F;  // metres a sweep

/// A lidar of 16 lasers that drives along x.
class OwnReturnsTest : public testing::Test {
protected:
  using Range = std::function<double(const Eigen::Vector3d& origin, const Eigen::Vector3d& along)>;

  OwnReturns own_{{}, Pose{Eigen::Vector3d(0, 0, kHeightOfLidar), Eigen::Quaterniond::Identity()}};
  std::mt19937 random_{7};
  double x_ = 0;

  /// @param body, world range of each beam, metres; 0 for none. The body's is in the lidar's frame
  /// @param way that the wheel claims
  bool sweep(const Range& body, const Range& world, float way = kStepLength,
             double moved = kStepLength) {
    std::normal_distribution<double> noise(0, 0.01);
    for (int laser = 0; laser < 16; ++laser) {
      for (int i = 0; i < 900; ++i) {
        const double up = (2 * laser - 15) * std::numbers::pi / 180;
        const double azimuth = 2 * std::numbers::pi * i / 900;
        const Eigen::Vector3d along(std::cos(up) * std::cos(azimuth),
                                    std::cos(up) * std::sin(azimuth), std::sin(up));
        double range = body(Eigen::Vector3d::Zero(), along);
        if (range == 0) range = world(Eigen::Vector3d(x_, 0, kHeightOfLidar), along);
        if (range <= 0 || range > 30) continue;
        own_.take(((range + noise(random_)) * along).cast<float>());
      }
    }
    x_ += moved;
    return own_.end_sweep(way);
  }
  /// @return sweeps until a box is found; the most where none is
  int drive(int sweeps, const Range& body, const Range& world, float way = kStepLength,
            double moved = kStepLength) {
    for (int i = 0; i < sweeps; ++i) {
      if (sweep(body, world, way, moved)) return i;
    }
    return sweeps;
  }
};

double nothing(const Eigen::Vector3d&, const Eigen::Vector3d&) {
  return 0;
}
/// A post behind the lidar, 0.1 m wide.
double post(const Eigen::Vector3d&, const Eigen::Vector3d& along) {
  constexpr double kAway = 0.8;
  if (along.x() >= 0 || std::abs(along.y() / along.x()) * kAway > 0.05) return 0;
  return kAway / -along.x();
}
/// Waves of 0.3 m.
double hills(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  constexpr double kTop = 0.3;
  // Down to their tops there is nothing.
  if (along.z() >= 0) return 0;
  for (double range = (kTop - origin.z()) / along.z(); range < 30; range += 0.05) {
    const Eigen::Vector3d at = origin + range * along;
    if (at.z() < kTop * std::sin(at.x()) * std::sin(0.7 * at.y())) return range;
  }
  return 0;
}
/// Level ground, and walls a metre to both sides.
double corridor(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  const double ground = along.z() < 0 ? -origin.z() / along.z() : 1e9;
  const double wall = along.y() != 0 ? 1 / std::abs(along.y()) : 1e9;
  return std::min(ground, wall);
}

/// Hills, and a wall of 2 m beside the way that wavers by 2.5 cm: where it is met obliquely its
/// range changes by more.
double wavering_wall(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  const double behind = hills(origin, along);
  if (along.y() <= 0) return behind;
  double range = 1.4 / along.y();
  for (int i = 0; i < 5; ++i) {
    range = (1.4 + 0.025 * std::sin(1.5 * (origin.x() + range * along.x()))) / along.y();
  }
  const bool is_hit = origin.z() + range * along.z() < 2 && range < 30;
  return is_hit && (behind == 0 || range < behind) ? range : behind;
}

/// Hills, and a bank 2 m long and 0.45 m high beside the way.
double bank(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  constexpr double kBeside = -1.2;
  const double range = along.y() < 0 ? kBeside / along.y() : 0;
  const Eigen::Vector3d at = origin + range * along;
  const bool is_hit = range > 0 && at.z() > 0 && at.z() < 0.45 && at.x() > 4 && at.x() < 6;
  const double behind = hills(origin, along);
  return is_hit && (behind == 0 || range < behind) ? range : behind;
}

TEST_F(OwnReturnsTest, WhatKeepsItsPlaceOnAMovingRobotGetsABox) {
  const int sweeps = drive(40, post, hills);
  EXPECT_LT(sweeps, 35);  // 2.8 metres
  ASSERT_EQ(own_.found().size(), 1U);
  const BodyBox& box = own_.found()[0];
  EXPECT_TRUE(box.contains({-0.8, 0, kHeightOfLidar}));
  EXPECT_TRUE(box.contains({-0.8, 0.04, kHeightOfLidar + 0.15}));
  EXPECT_LT((box.high - box.low).head<2>().maxCoeff(), 0.5);
  EXPECT_TRUE(own_.take({-0.8F, 0, 0.1F}));
  EXPECT_FALSE(own_.take({0.8F, 0, 0.1F}));
  sweep(post, hills);
  EXPECT_GT(own_.returns(), 100U);
  EXPECT_EQ(drive(40, post, hills), 40) << "the same again";
}

TEST_F(OwnReturnsTest, IsSuspectBeforeItIsKnown) {
  for (int i = 0; i < 6; ++i) sweep(post, hills);
  own_.take({-0.8F, 0, 0.014F});
  EXPECT_TRUE(own_.is_suspect());
  own_.take({-1.2F, 0, 0.021F});
  EXPECT_FALSE(own_.is_suspect());
  EXPECT_TRUE(own_.found().empty());
}

TEST_F(OwnReturnsTest, ARobotThatStandsTellsNothing) {
  EXPECT_EQ(drive(60, post, hills, 0, 0), 60);
}

TEST_F(OwnReturnsTest, NorDoesAWheelThatSpins) {
  const auto rock = [](const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
    const double there = post(origin, along);
    return there > 0 ? there : hills(origin, along);
  };
  EXPECT_EQ(drive(60, nothing, rock, kStepLength, 0), 60);
}

TEST_F(OwnReturnsTest, WallsBesideTheWayAreNotTheRobot) {
  EXPECT_EQ(drive(100, nothing, corridor), 100);
  EXPECT_EQ(drive(100, nothing, hills), 100);
  x_ = 0;
  EXPECT_EQ(drive(100, nothing, bank), 100);
  EXPECT_EQ(drive(100, nothing, wavering_wall), 100);
}

TEST_F(OwnReturnsTest, TheOwnersBoxesAreTakenOut) {
  own_ = OwnReturns(std::vector<BodyBox>{{{-1, -0.2, 0.5}, {-0.6, 0.2, 1.5}}},
                    Pose{Eigen::Vector3d(0, 0, kHeightOfLidar), Eigen::Quaterniond::Identity()});
  EXPECT_TRUE(own_.take({-0.8F, 0, 0}));
  EXPECT_FALSE(own_.take({-1.1F, 0, 0}));
  EXPECT_EQ(drive(40, post, hills), 40) << "nothing is left to find";
}

TEST_F(OwnReturnsTest, TakesAnyPoint) {
  const float nan = std::nanf("");
  own_.take({nan, nan, nan});
  own_.take({0, 0, 0});
  own_.take({1e30F, 1e30F, 1e30F});
  EXPECT_FALSE(own_.end_sweep(1));
}

}  // namespace
}  // namespace scree
