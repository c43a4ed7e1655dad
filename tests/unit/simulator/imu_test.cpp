#include "simulator/imu.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

namespace scree {
namespace {

/// Reads one message by the protocol's documentation alone: ids and the bytes of their values.
std::map<int, std::vector<std::uint8_t>> parse(const std::vector<std::uint8_t>& message) {
  std::map<int, std::vector<std::uint8_t>> values;
  EXPECT_EQ(message[0], 0xFA);
  EXPECT_EQ(message[1], 0xFF);
  EXPECT_EQ(message[2], 0x36);
  EXPECT_EQ(message[3] + 5U, message.size());
  int sum = 0;
  for (std::size_t i = 1; i < message.size(); ++i) sum += message[i];
  EXPECT_EQ(sum % 256, 0);
  for (std::size_t i = 4; i + 3 < message.size();) {
    const std::size_t size = message[i + 2];
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(i) + 3;
    values[message[i] * 256 + message[i + 1]] = {begin, begin + static_cast<std::ptrdiff_t>(size)};
    i += 3 + size;
  }
  return values;
}

double number(const std::vector<std::uint8_t>& bytes, std::size_t index) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits = bits << 8U | bytes[4 * index + i];
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

TEST(Xbus, MessageReadsBackByTheDocumentation) {
  ImuMessage sample;
  sample.packet_counter = 0xABCD;
  sample.sample_time_fine = 0x01020304;
  sample.orientation = {0.5, -0.5, 0.5, 0.5};
  sample.acceleration = {0.25, -0.5, 9.75};
  sample.rate_of_turn = {-1, 0.125, 2};
  sample.status = 3;
  auto values = parse(mt_data2(sample));
  ASSERT_EQ(values.size(), 6U);
  EXPECT_EQ(values[0x1020], (std::vector<std::uint8_t>{0xAB, 0xCD}));
  EXPECT_EQ(values[0x1060], (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_EQ(values[0xE020], (std::vector<std::uint8_t>{0, 0, 0, 3}));
  EXPECT_EQ(number(values[0x2010], 0), 0.5);
  EXPECT_EQ(number(values[0x2010], 1), -0.5);
  EXPECT_EQ(number(values[0x4020], 2), 9.75);
  EXPECT_EQ(number(values[0x8020], 1), 0.125);
  // Wake-up as the documentation prints it.
  EXPECT_EQ(xbus_message(xsens::MessageId::wake_up, {}),
            (std::vector<std::uint8_t>{0xFA, 0xFF, 0x3E, 0x00, 0xC3}));
}

SimulatedImuSettings without_errors() {
  SimulatedImuSettings settings;
  settings.gyro_noise = settings.gyro_bias = settings.gyro_walk = settings.gyro_vibration = 0;
  settings.acceleration_noise = settings.acceleration_bias = settings.acceleration_vibration = 0;
  settings.tilt_error = settings.yaw_drift = 0;
  return settings;
}

/// Circles of 2 m at 1 m/s on a slope that tilts the body by 0.1 rad sideways.
Motion circle() {
  std::vector<Pose> knots;
  for (int i = 0; i < 4000; ++i) {
    const double yaw = 0.0025 * i / 2;
    knots.push_back(
        {{2 * std::sin(yaw), 2 - 2 * std::cos(yaw), 0}, from_roll_pitch_yaw(0.1, 0, yaw)});
  }
  return {std::move(knots), 0, 2'500'000};
}

TEST(SimulatedImu, MeasuresRatesForcesAndOrientation) {
  const Motion motion = circle();
  const Pose mount{{0, 0, 0}, from_roll_pitch_yaw(0, 0, radians(90))};
  SimulatedImuSettings settings = without_errors();
  settings.yaw_offset = 0.7;
  SimulatedImu imu(motion, mount, settings, 1'000'000'000, 1);
  for (int i = 0; i < 500; ++i) {
    const ImuMessage sample = imu.next();
    EXPECT_EQ(sample.t_ns, 1'000'000'000 + i * 10'000'000LL);
    // The sensor's x axis points to the left of the body: which turns about the world's z axis.
    const Eigen::Vector3d turning(0.5 * std::sin(0.1), 0, 0.5 * std::cos(0.1));
    EXPECT_LT((sample.rate_of_turn - turning).norm(), 1e-3);
    // Gravity, and 0.5 m/s^2 towards the circle's centre, to the left.
    const Eigen::Vector3d force(0.5 * std::cos(0.1) + 9.81 * std::sin(0.1), 0,
                                9.81 * std::cos(0.1) - 0.5 * std::sin(0.1));
    EXPECT_LT((sample.acceleration - force).norm(), 0.02);
    const Eigen::Quaterniond expected =
        from_roll_pitch_yaw(0, 0, 0.7) * motion.base(sample.t_ns).rotation * mount.rotation;
    EXPECT_LT(sample.orientation.angularDistance(expected), 1e-6);
  }
}

TEST(SimulatedImu, CountsAndKeepsItsOwnTime) {
  const Motion motion{Pose()};
  SimulatedImuSettings settings = without_errors();
  settings.clock_skew = 1e-4;
  settings.rate_hz = 400;
  SimulatedImu imu(motion, Pose(), settings, 0, 1);
  const ImuMessage first = imu.next();
  ImuMessage last;
  for (int i = 0; i < 40000; ++i) last = imu.next();
  EXPECT_EQ(static_cast<std::uint16_t>(last.packet_counter - first.packet_counter), 40000U);
  EXPECT_EQ(last.sample_time_fine - first.sample_time_fine, 1'000'000U);  // 100 s of its own
  EXPECT_NEAR(static_cast<double>(last.t_ns), 100e9 - 100e9 * 1e-4, 2e6);
}

TEST(SimulatedImu, ErrorsAreAsLargeAsSet) {
  const Motion motion{Pose()};
  SimulatedImuSettings settings = without_errors();
  settings.tilt_error = 0.005;
  settings.tilt_correlation = 2;
  settings.gyro_noise = 0.01;
  SimulatedImu imu(motion, Pose(), settings, 0, 3);
  double tilt = 0;
  double rate = 0;
  constexpr int kSamples = 60000;
  for (int i = 0; i < kSamples; ++i) {
    const ImuMessage sample = imu.next();
    const double lean = (sample.orientation * Eigen::Vector3d::UnitZ()).head<2>().squaredNorm();
    tilt += lean / 2;
    rate += sample.rate_of_turn.squaredNorm() / 3;
  }
  EXPECT_NEAR(std::sqrt(tilt / kSamples), 0.005, 0.001);
  EXPECT_NEAR(std::sqrt(rate / kSamples), 0.01, 0.0003);
}

}  // namespace
}  // namespace scree
