#include "scree/motion/setup_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scree/core/pose.hpp"

namespace scree {
namespace {

using testing::HasSubstr;

Settings robot() {
  Settings settings;
  settings.lidar.translation = {0.1, 0, 0.95};
  settings.lidar.rpy_deg = {0, 6, 0};
  settings.imu.rpy_deg = {0, 0, 90};
  settings.encoder.scale = 0.0002;
  return settings;
}

/// A robot on rough ground: what its sensors measure over each half second, without error.
class Robot {
public:
  explicit Robot(const Settings& truth) : truth_(truth) {}

  /// @param speed m/s; @param rate of yaw, rad/s
  SetupWindow window(double speed, double rate) {
    constexpr double kSeconds = 0.5;
    ++number_;
    const double swing = 0.03 * std::sin(2.1 * number_), sway = 0.02 * std::sin(1.3 * number_);
    const Eigen::Vector3d turn(sway, swing, rate * kSeconds);
    const Eigen::Vector3d way(speed * kSeconds, 0, 0);
    const Eigen::Vector3d change((speed - speed_) / kSeconds, 0, 0);
    speed_ = speed;
    const Pose lidar = truth_.lidar.mount();
    const Eigen::Quaterniond to_lidar = lidar.rotation.conjugate();
    const Eigen::Quaterniond to_imu = truth_.imu.mount().rotation.conjugate();
    SetupWindow window;
    window.seconds = kSeconds;
    window.is_bound = window.binds = true;
    window.way = to_lidar * (way + turn.cross(lidar.translation));
    window.turn = to_lidar * turn;
    const GroundPlane ground{to_lidar * Eigen::Vector3d::UnitZ(), lidar.translation.z()};
    window.around = window.below = ground;
    window.has_imu = window.has_force = true;
    window.imu_turn = to_imu * turn;
    window.imu_up = to_imu * Eigen::Vector3d::UnitZ();
    window.imu_force = to_imu * change;
    window.has_wheel = true;
    window.wheel = way.x() - turn.z() * truth_.encoder.translation.y();
    // Both gain evenly from window to window.
    window.imu_turn_before = (1 - kEarlier) * window.imu_turn + kEarlier * imu_turn_;
    window.wheel_before = (1 - kEarlier) * window.wheel + kEarlier * wheel_;
    imu_turn_ = window.imu_turn;
    wheel_ = window.wheel;
    return window;
  }

  /// The same with messages of the IMU, or the encoder, that are late: seconds, 0.1 at most.
  SetupWindow late_window(double speed, double rate, double imu, double wheel) {
    SetupWindow window = this->window(speed, rate);
    const Eigen::Vector3d turn_gain = window.imu_turn - window.imu_turn_before;
    const double wheel_gain = window.wheel - window.wheel_before;
    window.imu_turn -= imu / SetupWindow::kBefore * turn_gain;
    window.imu_turn_before -= imu / SetupWindow::kBefore * turn_gain;
    window.wheel -= wheel / SetupWindow::kBefore * wheel_gain;
    window.wheel_before -= wheel / SetupWindow::kBefore * wheel_gain;
    return window;
  }

private:
  static constexpr double kEarlier = SetupWindow::kBefore / 0.5;  // of a window

  Settings truth_;
  int number_ = 0;
  double speed_ = 0, wheel_ = 0;
  Eigen::Vector3d imu_turn_ = Eigen::Vector3d::Zero();
};

/// What a drive with turns says against these settings.
std::string said_of(const Settings& settings, const Settings& truth = robot(),
                    double wheel_factor = 1) {
  SetupWatch watch(settings);
  Robot driven(truth);
  for (int i = 0; i < 18; ++i) {
    SetupWindow window = driven.window(std::min(0.2 * i, 1.0), i < 11 ? 0.1 : 0.7);
    window.wheel *= wheel_factor;
    watch.add(window);
  }
  std::string said;
  for (const SetupFinding& finding : watch.report()) {
    said += (finding.is_grave ? "! " : "") + sentence(finding) + "\n";
  }
  return said;
}

TEST(SetupWatchTest, SaysNothingOfARightRobot) {
  EXPECT_EQ(said_of(robot()), "");
}

TEST(SetupWatchTest, NamesALidarThatLooksElsewhere) {
  Settings settings = robot();
  settings.lidar.rpy_deg.y() += 5;
  EXPECT_EQ(said_of(settings),
            "! lidar.rpy_deg looks turned by 5 degrees about y: set [0, 6, 0]\n");
  settings = robot();
  settings.lidar.rpy_deg.z() += 10;
  EXPECT_THAT(said_of(settings),
              HasSubstr("! lidar.rpy_deg looks turned by 10 degrees about z: set [0, 6, 0]"));
}

TEST(SetupWatchTest, NamesALidarAtAnotherHeight) {
  Settings settings = robot();
  settings.lidar.translation.z() = 0.5;
  EXPECT_EQ(said_of(settings), "! lidar.translation looks 0.45 m too low: set [0.1, 0, 0.95]\n");
}

TEST(SetupWatchTest, NamesWhatWasLeftAsDelivered) {
  Settings settings = robot();
  settings.lidar.translation.setZero();
  settings.lidar.rpy_deg.setZero();
  const std::string said = said_of(settings);
  EXPECT_THAT(said, HasSubstr("! lidar.translation looks 0.95 m too low"));
  EXPECT_THAT(said, HasSubstr("! lidar.rpy_deg looks turned by 6 degrees about y"));
  EXPECT_THAT(said, HasSubstr("as delivered"));
}

TEST(SetupWatchTest, NamesAnImuThatLiesOtherwise) {
  Settings settings = robot();
  settings.imu.rpy_deg = {0, 0, -90};
  EXPECT_EQ(said_of(settings),
            "! imu.rpy_deg looks turned by 180 degrees about z: set [0, 0, 90]\n");
  settings.imu.rpy_deg = {180, 0, -90};
  EXPECT_EQ(said_of(settings),
            "! imu.rpy_deg looks turned by 180 degrees about x: set [0, 0, 90]\n");
  settings.imu.rpy_deg = {0, 0, 0};
  EXPECT_EQ(said_of(settings),
            "! imu.rpy_deg looks turned by 90 degrees about z: set [0, 0, 90]\n");
}

TEST(SetupWatchTest, NamesAScaleAndItsSign) {
  EXPECT_EQ(said_of(robot(), robot(), 2),
            "! encoder.scale looks 2.0 times too large: set 0.0001\n");
  EXPECT_EQ(said_of(robot(), robot(), -1),
            "! encoder.scale looks of the wrong sign: set -0.0002\n");
  EXPECT_EQ(said_of(robot(), robot(), -0.5),
            "! encoder.scale looks of the wrong sign and 2.0 times too small: set -0.0004\n");
}

TEST(SetupWatchTest, NamesAWheelBesideTheMiddle) {
  Settings truth = robot();
  truth.encoder.translation.y() = 0.4;
  EXPECT_EQ(said_of(robot(), truth),
            "encoder.translation looks 0.40 m too far to the right: set [0, 0.4, 0]\n");
  EXPECT_EQ(said_of(truth, truth), "");
}

/// What a drive with starts, stops and turns says of late messages.
std::string said_of_late(const Settings& settings, double imu, double wheel) {
  SetupWatch watch(settings);
  Robot driven(robot());
  for (int i = 0; i < 18; ++i) {
    watch.add(driven.late_window(0.7 + 0.4 * std::sin(i), 0.6 * std::sin(0.8 * i), imu, wheel));
  }
  std::string said;
  for (const SetupFinding& finding : watch.report()) said += sentence(finding) + "\n";
  return said;
}

TEST(SetupWatchTest, NamesMessagesThatAreLate) {
  EXPECT_EQ(said_of_late(robot(), 0.02, 0.03), "");
  EXPECT_EQ(said_of_late(robot(), 0.09, 0), "imu.delay looks 0.09 s too small: set 0.09\n");
  EXPECT_THAT(said_of_late(robot(), 0, 0.08),
              testing::MatchesRegex("encoder.delay looks 0.0[678] s too small: set 0.0[678]\n"));
  Settings settings = robot();
  settings.imu.delay = 0.07;
  EXPECT_EQ(said_of_late(settings, -0.07, 0), "imu.delay looks 0.07 s too large: set 0\n");
  settings.imu.delay = 0.08;
  EXPECT_EQ(
      said_of_late(settings, 0.08, 0),
      "imu.delay looks 0.08 s too small: more than the key takes; find what holds up the imu's "
      "messages\n");
}

/// A wheel that spins is no wrong scale once that was right; it is one after as long.
TEST(SetupWatchTest, DoesNotTakeSlipForAScale) {
  SetupWatch watch(robot());
  Robot driven(robot());
  for (int i = 0; i < 24; ++i) watch.add(driven.window(1, 0.1));
  const auto spin = [&](int windows) {
    for (int i = 0; i < windows; ++i) {
      SetupWindow window = driven.window(1, 0.1);
      window.wheel *= 2;
      watch.add(window);
    }
    return watch.report().count;
  };
  EXPECT_EQ(spin(10), 0U);
  EXPECT_EQ(spin(30), 1U);
  for (int i = 0; i < 24; ++i) watch.add(driven.window(1, 0.1));
  EXPECT_EQ(watch.report().count, 0U);
}

/// Among people who walk past, the lidar may drift off: aside and too far.
TEST(SetupWatchTest, DoesNotJudgeTheScaleByALidarThatDriftsAside) {
  SetupWatch watch(robot());
  Robot driven(robot());
  for (int i = 0; i < 24; ++i) {
    SetupWindow window = driven.window(1, 0.1);
    const double aside = radians(30 * (i % 3) - 25);
    window.way = 1.5 * (Eigen::AngleAxisd(aside, Eigen::Vector3d::UnitZ()) * window.way);
    watch.add(window);
  }
  EXPECT_EQ(watch.report().count, 0U);
}

TEST(SetupWatchTest, DoesNotJudgeByWhatIsNotBound) {
  Settings settings = robot();
  settings.lidar.rpy_deg.z() += 10;
  SetupWatch watch(settings);
  Robot driven(robot());
  for (int i = 0; i < 24; ++i) {
    SetupWindow window = driven.window(1, 0.1);
    window.is_bound = false;
    window.wheel *= 3;
    watch.add(window);
  }
  EXPECT_EQ(watch.report().count, 0U);
}

TEST(SetupWatchTest, DoesNotJudgeARobotThatStands) {
  Settings settings = robot();
  settings.lidar.translation.z() = 0.2;
  SetupWatch watch(settings);
  Robot driven(robot());
  for (int i = 0; i < 24; ++i) watch.add(driven.window(0, 0));
  EXPECT_EQ(watch.report().count, 0U);
}

}  // namespace
}  // namespace scree
