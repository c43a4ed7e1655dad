#include "scree/terrain/mapper.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "allocation_counter.hpp"
#include "terrain/rough_ground.hpp"

namespace scree {
namespace {

constexpr double kSweep = 0.1;

Settings usual_settings() {
  Settings settings;
  settings.lidar = test::usual_lidar();
  settings.memory.sweep_points = 1 << 13;
  settings.memory.map_voxels = 1 << 16;
  return settings;
}

/// A mapper on its way, sensors that speak when they are let, and the error of its pose.
class MapperTest : public testing::Test {
protected:
  test::SimpleDrive drive_ = test::helix(1, 0.25, 0, 0.03);
  test::RoughGround ground_;
  Settings settings_ = usual_settings();
  std::unique_ptr<Mapper> mapper_ = std::make_unique<Mapper>(settings_);
  std::unique_ptr<SyncBuffer> sensors_ = std::make_unique<SyncBuffer>();
  Sweep sweep_{1 << 13};
  std::int64_t shift_ns_ = 0;
  int sweeps_ = 0;

  void make(const Settings& settings) { mapper_ = std::make_unique<Mapper>(settings); }
  /// @param imu, wheel whether they speak
  void go(int sweeps, bool imu = true, bool wheel = true) {
    for (int i = 0; i < sweeps; ++i) {
      for (int k = 10 * sweeps_; k < 10 * (sweeps_ + 1); ++k) {
        ImuSample turned = drive_.imu(0.01 * (k + 1));
        EncoderSample rolled = drive_.wheel(0.01 * (k + 1));
        turned.t_ns += shift_ns_;
        rolled.t_ns += shift_ns_;
        if (imu) sensors_->put(turned);
        if (wheel) sensors_->put(rolled);
      }
      ++sweeps_;
      test::scan(ground_, drive_, settings_.lidar, kSweep * sweeps_, sweep_);
      sweep_.end_ns += shift_ns_;
      add();
    }
  }
  void add() {
    sensors_->gather();
    mapper_->add(sweep_, *sensors_);
    ASSERT_TRUE(mapper_->pose().translation.allFinite());
    ASSERT_TRUE(mapper_->filter().covariance().allFinite());
    ASSERT_NEAR(mapper_->pose().rotation.norm(), 1, 1e-6);
  }
  /// The pose's error, from the end of the first sweep on.
  Pose error() const { return test::relative(truth(), mapper_->pose()); }
  Pose truth() const {
    // Where the drive begins lies the origin of both, but for the way of the first sweep.
    const Pose now = drive_.base(kSweep * sweeps_), first = drive_.base(kSweep);
    const Eigen::Quaterniond level = exponential({0, 0, -yaw_of(first.rotation)});
    return {level * (now.translation - first.translation), level * now.rotation};
  }
  void expect_near(double metres, double degrees_of_yaw) const {
    EXPECT_LT(error().translation.norm(), metres) << sweeps_;
    EXPECT_LT(std::abs(yaw_of(error().rotation)), radians(degrees_of_yaw)) << sweeps_;
  }
  /// Drives on; how far the way is from the true one, metres.
  double error_of_way(int sweeps) {
    const Pose before = mapper_->pose(), true_before = drive_.base(kSweep * sweeps_);
    go(sweeps);
    const Pose moved = test::relative(before, mapper_->pose());
    const Pose truly = test::relative(true_before, drive_.base(kSweep * sweeps_));
    return (moved.translation - truly.translation).norm();
  }
  /// Root of the mean square of the map's distances from the ground, metres.
  double roughness_of_map() const {
    const Pose first = drive_.base(kSweep);
    const Eigen::Quaterniond level = exponential({0, 0, yaw_of(first.rotation)});
    const PointCloud& cloud = mapper_->map().cloud();
    double squares = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d point =
          level * (mapper_->map().origin() + Eigen::Vector3d(cloud.x[i], cloud.y[i], cloud.z[i])) +
          first.translation;
      const double off = point.z() - ground_.height(point.x(), point.y());
      squares += off * off;
    }
    return std::sqrt(squares / static_cast<double>(cloud.size()));
  }
};

TEST_F(MapperTest, FollowsTheRobotAndRebuildsTheGround) {
  go(50);
  expect_near(0.03, 0.3);
  EXPECT_GT(mapper_->map().cloud().size(), 3000U);
  EXPECT_LT(roughness_of_map(), 0.03);
  EXPECT_GT(mapper_->registration().key_points, 100);
}

TEST_F(MapperTest, RegistrationMendsAWheelThatCountsTooMuch) {
  drive_.scale = 1.03;
  settings_.map.registration = false;
  make(settings_);
  go(50);
  const double alone = error().translation.norm();
  EXPECT_GT(alone, 0.06);
  EXPECT_EQ(mapper_->registration().key_points, 0);

  settings_.map.registration = true;
  make(settings_);
  sensors_ = std::make_unique<SyncBuffer>();
  sweeps_ = 0;
  go(50);
  EXPECT_LT(error().translation.norm(), 0.5 * alone);
  EXPECT_LT(mapper_->filter().scale_error(), -0.002);
}

TEST_F(MapperTest, LivesThroughAnImuThatIsSilentAndBack) {
  go(20);
  go(20, false);
  EXPECT_FALSE(mapper_->step().knows_attitude);
  expect_near(0.15, 3);
  const double unsure = mapper_->filter().rotation_deviation().z();
  go(15);
  EXPECT_TRUE(mapper_->step().knows_attitude);
  expect_near(0.15, 0.5);
  EXPECT_LE(mapper_->filter().rotation_deviation().z(), unsure);
  EXPECT_LT(roughness_of_map(), 0.05);
}

TEST_F(MapperTest, WhileTheImuIsSilentOnlyWhatIsSurelyInItsPlaceIsMapped) {
  const auto far = [&] {
    const RollingMap& map = mapper_->map();
    const Eigen::Vector3f here = (mapper_->pose().translation - map.origin()).cast<float>();
    int points = 0;
    for (std::size_t i = 0; i < map.cloud().size(); ++i) {
      const float x = map.cloud().x[i] - here.x(), y = map.cloud().y[i] - here.y();
      if (std::hypot(x, y) > 7) ++points;
    }
    return points;
  };
  go(20);
  int before = far();
  go(20, false);
  const int on_a_smooth_way = far();
  EXPECT_GT(on_a_smooth_way, 1.5 * before) << "there a guess serves";

  make(settings_);
  sensors_ = std::make_unique<SyncBuffer>();
  sweeps_ = 0;
  const auto smooth = drive_.base;
  drive_.base = [smooth](double t) {
    Pose base = smooth(t);
    base.rotation = base.rotation * from_roll_pitch_yaw(0, 0.05 * std::sin(9 * t), 0);
    return base;
  };
  go(20);
  before = far();
  go(20, false);
  EXPECT_LT(far(), 0.5 * on_a_smooth_way) << "and on a bumpy one it does not";
  EXPECT_LT(roughness_of_map(), 0.05);
  go(15);
  EXPECT_GT(far(), 1.3 * before);
}

TEST_F(MapperTest, LivesThroughAnImuThatStartsOver) {
  go(20);
  go(20, false);
  drive_.yaw_offset = 2;
  go(15);
  EXPECT_TRUE(mapper_->step().knows_attitude);
  expect_near(0.2, 3);
  EXPECT_LT(roughness_of_map(), 0.05);
}

TEST_F(MapperTest, LivesThroughAnEncoderThatIsSilent) {
  go(20);
  go(30, true, false);
  EXPECT_FALSE(mapper_->step().knows_distance);
  expect_near(0.15, 0.5);
  go(15);
  EXPECT_TRUE(mapper_->step().knows_distance);
  expect_near(0.15, 0.5);
}

TEST_F(MapperTest, ASensorMayBeginLate) {
  // The robot leans while the IMU is still to come.
  drive_ = test::helix(1, 0.2, 0.1, 0);
  ground_.roughness = 0.2;
  go(5, false, false);
  EXPECT_LT(mapper_->pose().rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.02);
  go(5, false, true);
  drive_.yaw_offset = -2.5;
  const double yaw = yaw_of(mapper_->pose().rotation);
  go(1);
  EXPECT_TRUE(mapper_->step().knows_attitude && mapper_->step().knows_distance);
  EXPECT_NEAR(yaw_of(mapper_->pose().rotation), yaw, 0.1) << "the yaw of odom stays";
  const Eigen::Vector3d ahead = mapper_->pose().rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(ahead.z(), std::sin(0.1), 0.01) << "the tilt is the IMU's";
  EXPECT_LT(error_of_way(20), 0.1);
}

TEST_F(MapperTest, StandsStillWithoutAnySensorButTheLidar) {
  drive_ = test::helix(0, 0, 0);
  go(15, false, false);
  EXPECT_LT(mapper_->pose().translation.norm(), 0.01);
  EXPECT_LT(mapper_->pose().rotation.angularDistance(Eigen::Quaterniond::Identity()), radians(0.2));
  EXPECT_GT(mapper_->map().cloud().size(), 1000U);
}

// By hours and years, in both directions; the map starts anew, the pose goes on.
TEST_F(MapperTest, GoesOnWhenTheClockIsSet) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  go(15);
  for (const std::int64_t shift : {kHour, -kHour, 400'000 * kHour, -400'000 * kHour}) {
    shift_ns_ += shift;
    go(12);
    EXPECT_TRUE(mapper_->step().knows_attitude && mapper_->step().knows_distance) << shift;
    expect_near(0.15, 2);
    EXPECT_GT(mapper_->map().cloud().size(), 1000U) << shift;
    EXPECT_LT(roughness_of_map(), 0.05) << shift;
  }
}

TEST_F(MapperTest, TakesEmptySweepsAndSweepsOfNonsense) {
  sweep_.end_ns = test::nanoseconds(0);
  add();
  EXPECT_LT(error_of_way(10), 0.04);
  for (int i = 0; i < 3; ++i) {
    sweep_.clear();
    sweep_.end_ns = test::nanoseconds(kSweep * sweeps_ + 0.01 * i);
    add();
    EXPECT_EQ(mapper_->sweep().points.size(), 0U);
  }
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 1e30F,
                          -std::numeric_limits<float>::infinity(), 0.0F}) {
    for (int i = 0; i < 500; ++i) {
      sweep_.push_back({bad, bad, 1}, bad, -1000, 0);
    }
  }
  sweep_.end_ns = test::nanoseconds(kSweep * sweeps_ + 0.05);
  add();
  go(1);
  EXPECT_LT(error_of_way(10), 0.04);
}

TEST_F(MapperTest, AllocatesNothingWhateverHappens) {
  go(3);
  const std::size_t before = test::allocations();
  go(4);
  go(3, false, false);
  shift_ns_ = 3'600'000'000'000;
  go(3);
  sweep_.clear();
  sweep_.end_ns = test::nanoseconds(kSweep * sweeps_) + shift_ns_;
  add();
  EXPECT_EQ(test::allocations(), before);
}

TEST_F(MapperTest, IsTheSameOnEveryRun) {
  go(12);
  const Pose pose = mapper_->pose();
  const PoseFilter::Covariance covariance = mapper_->filter().covariance();
  make(settings_);
  sensors_ = std::make_unique<SyncBuffer>();
  sweeps_ = 0;
  go(12);
  EXPECT_EQ(mapper_->pose().translation, pose.translation);
  EXPECT_EQ(mapper_->pose().rotation.coeffs(), pose.rotation.coeffs());
  EXPECT_EQ(mapper_->filter().covariance(), covariance);
}

}  // namespace
}  // namespace scree
