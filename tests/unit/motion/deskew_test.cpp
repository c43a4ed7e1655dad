#include "scree/motion/deskew.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "motion/simple_drive.hpp"
#include "scree/motion/dead_reckoning.hpp"

namespace scree {
namespace {

constexpr double kEnd = 1.0, kLength = 0.1;

LidarSettings mounted() {
  LidarSettings lidar;
  lidar.translation = {0.3, -0.1, 0.9};
  lidar.rpy_deg = {2, 6, -20};
  return lidar;
}

Pose lidar_at(const test::SimpleDrive& drive, const LidarSettings& lidar, double t) {
  return drive.base(t) * lidar.mount();
}

class DeskewTest : public testing::Test {
protected:
  // Turning, climbing and rolling at once.
  test::SimpleDrive drive_ = test::helix(2, 0.8, 0.15, 0.1);
  LidarSettings lidar_ = mounted();
  Sweep sweep_{1 << 14};
  OwnReturns own_{{}, lidar_.mount()};
  DeskewedSweep out_{1 << 14};
  SweepTrajectory trajectory_;

  void follow() {
    const auto sensors = std::make_unique<SyncBuffer>();
    drive_.put(*sensors, 0, 1.2);
    DeadReckoning reckoning(drive_.imu_mount);
    sweep_.end_ns = test::nanoseconds(kEnd);
    reckoning.advance(*sensors, test::nanoseconds(kEnd - kLength), sweep_.end_ns, trajectory_);
    deskew(sweep_, lidar_, trajectory_, own_, out_);
  }
  /// A beam at a time in each direction of a turn, three together; `range` of beams in the world.
  template <class Range>
  void scan(const Range& range) {
    for (int i = 0; i < 3000; ++i) {
      const double t = kEnd - kLength + kLength * (i / 3) / 999.0;
      const double azimuth = 2 * std::numbers::pi * (i / 3) / 1000, up = 0.2 * (i % 3 - 1);
      const Eigen::Vector3d along(std::cos(azimuth) * std::cos(up),
                                  -std::sin(azimuth) * std::cos(up), std::sin(up));
      const Pose at = lidar_at(drive_, lidar_, t);
      const double far = range(at.translation, at.rotation * along);
      if (far <= 0) continue;
      sweep_.push_back((far * along).cast<float>(), static_cast<float>(i % 100),
                       static_cast<std::int32_t>(std::llround((t - kEnd) * 1e9)),
                       static_cast<std::size_t>(i % 3));
    }
  }
  Eigen::Vector3d point(std::size_t i) const {
    return Eigen::Vector3f(out_.points.x[i], out_.points.y[i], out_.points.z[i]).cast<double>();
  }
};

TEST_F(DeskewTest, AWallComesOutFlat) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0.3, 0.1).normalized();
  constexpr double kWall = 9;
  scan([&](const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
    const double closing = normal.dot(along);
    const double range = closing > 0.05 ? (kWall - normal.dot(from)) / closing : 0;
    return range < 25 ? range : 0;
  });
  follow();
  ASSERT_GT(out_.points.size(), 500U);
  double worst = 0;
  for (std::size_t i = 0; i < out_.points.size(); ++i) {
    worst = std::max(worst, std::abs(normal.dot(drive_.base(kEnd) * point(i)) - kWall));
  }
  EXPECT_LT(worst, 1e-3);
  // The sweep as it was seen is bent far more than that.
  worst = 0;
  const Pose end = lidar_at(drive_, lidar_, kEnd);
  for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
    const Eigen::Vector3d seen(sweep_.points.x[i], sweep_.points.y[i], sweep_.points.z[i]);
    worst = std::max(worst, std::abs(normal.dot(end * seen) - kWall));
  }
  EXPECT_GT(worst, 0.1);
}

TEST_F(DeskewTest, IsTheTransformOfEachPointByItself) {
  scan([](const Eigen::Vector3d&, const Eigen::Vector3d& along) { return 10 + 5 * along.x(); });
  follow();
  ASSERT_EQ(out_.points.size(), sweep_.points.size());
  ASSERT_EQ(out_.origins.size(), sweep_.points.size());
  const Pose end = drive_.base(kEnd);
  for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
    const Eigen::Vector3d seen(sweep_.points.x[i], sweep_.points.y[i], sweep_.points.z[i]);
    const double t = kEnd + sweep_.time_ns[i] * 1e-9;
    const Pose then = test::relative(end, lidar_at(drive_, lidar_, t));
    ASSERT_LT((point(i) - then * seen).norm(), 1e-3) << i;
    ASSERT_LT((out_.origins[i].cast<double>() - then.translation).norm(), 2e-4) << i;
    ASSERT_EQ(out_.points.reflectivity[i], sweep_.points.reflectivity[i]);
  }
}

TEST_F(DeskewTest, MovesBeamsWithoutReturnToo) {
  for (int i = 0; i <= 10; ++i) {
    const Eigen::Vector3f along =
        Eigen::Vector3f(1, 0.2F * static_cast<float>(i), 0.3F).normalized();
    sweep_.empty.push_back({kNoReturnRange * along, -9'000'000 * (10 - i)});
  }
  follow();
  ASSERT_EQ(out_.empty.size(), sweep_.empty.size());
  const Pose end = drive_.base(kEnd);
  for (std::size_t i = 0; i < sweep_.empty.size(); ++i) {
    const double t = kEnd + sweep_.empty[i].time_ns * 1e-9;
    const Pose then = test::relative(end, lidar_at(drive_, lidar_, t));
    const Eigen::Vector3d expected = then * sweep_.empty[i].end.cast<double>();
    EXPECT_LT((out_.empty[i].end.cast<double>() - expected).norm(), 0.05) << i;
    EXPECT_LT((out_.empty[i].origin.cast<double>() - then.translation).norm(), 2e-4) << i;
  }
}

TEST_F(DeskewTest, LeavesOutWhatIsNearOrFarOrNoNumber) {
  lidar_.min_range = 1;
  lidar_.max_range = 10;
  constexpr float kBad = std::numeric_limits<float>::quiet_NaN();
  constexpr float kHuge = std::numeric_limits<float>::infinity();
  for (const float x : {0.9F, 1.1F, 9.9F, 10.1F, kBad, kHuge, -kHuge, -5.0F, 1e30F}) {
    sweep_.push_back({x, 0, 0}, 1, -1000, 0);
  }
  follow();
  EXPECT_EQ(out_.points.size(), 3U);
  EXPECT_EQ(out_.scatter.size(), 3U);
  EXPECT_EQ(out_.is_isolated.size(), 3U);
  EXPECT_EQ(out_.origins.size(), 3U);
  EXPECT_EQ(out_.dropped, 0U);
}

TEST_F(DeskewTest, CountsWhatDoesNotFitAndTakesAnEmptySweep) {
  out_ = DeskewedSweep(100);
  scan([](const Eigen::Vector3d&, const Eigen::Vector3d&) { return 5; });
  follow();
  EXPECT_EQ(out_.points.size(), 100U);
  EXPECT_EQ(out_.scatter.size(), 100U);
  EXPECT_EQ(out_.is_isolated.size(), 100U);
  EXPECT_EQ(out_.origins.size(), 100U);
  EXPECT_EQ(out_.dropped, 2900U);
  sweep_.clear();
  deskew(sweep_, lidar_, trajectory_, own_, out_);
  EXPECT_EQ(out_.points.size(), 0U);
  EXPECT_EQ(out_.dropped, 0U);
}

TEST_F(DeskewTest, ARobotThatStandsChangesNothing) {
  const SweepTrajectory still;
  sweep_.push_back({3, 2, 1}, 7, -90'000'000, 0);
  deskew(sweep_, lidar_, still, own_, out_);
  ASSERT_EQ(out_.points.size(), 1U);
  EXPECT_LT((point(0) - lidar_.mount() * Eigen::Vector3d(3, 2, 1)).norm(), 1e-6);
}

TEST_F(DeskewTest, LeavesOutTheRobotsOwnBody) {
  const Eigen::Vector3d deck = lidar_.mount() * Eigen::Vector3d(-1, 0, -0.3);
  const Eigen::Vector3d room(0.1, 0.1, 0.1);
  own_ = OwnReturns(std::vector<BodyBox>{{deck - room, deck + room}}, lidar_.mount());
  sweep_.push_back({-1, 0, -0.3F}, 7, 0, 0);
  sweep_.push_back({-2, 0, -0.6F}, 7, 0, 0);
  const SweepTrajectory still;
  deskew(sweep_, lidar_, still, own_, out_);
  ASSERT_EQ(out_.points.size(), 1U);
  EXPECT_LT((point(0) - lidar_.mount() * Eigen::Vector3d(-2, 0, -0.6)).norm(), 1e-6);
}

/// A filter's step may be below a nanosecond where the lidar's clock is broken.
TEST(SweepTrajectory, OfNoLengthAnswersWithItsBegin) {
  SweepTrajectory trajectory;
  trajectory.start(0);
  trajectory.push_back({});
  trajectory.push_back({Eigen::Matrix3f::Identity(), {1, 2, 3}});
  EXPECT_EQ(trajectory.at(0).translation, Eigen::Vector3f::Zero());
  EXPECT_EQ(trajectory.at(100'000'000).translation, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(trajectory.at(std::numeric_limits<std::int64_t>::max()).translation,
            Eigen::Vector3f(1, 2, 3));
}

}  // namespace
}  // namespace scree
