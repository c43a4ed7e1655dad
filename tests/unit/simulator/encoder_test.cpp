#include "simulator/encoder.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(Signal, LiesInTheFrameAsDbcSays) {
  EncoderSettings layout;
  CanData data{};
  put_signal(data, layout, 0x01020304);
  EXPECT_EQ(data, (CanData{4, 3, 2, 1, 0, 0, 0, 0}));

  layout.byte_order = ByteOrder::big_endian;
  layout.start_bit = 7;
  data = {};
  put_signal(data, layout, 0x01020304);
  EXPECT_EQ(data, (CanData{1, 2, 3, 4, 0, 0, 0, 0}));

  layout.byte_order = ByteOrder::little_endian;
  layout.start_bit = 12;
  layout.length = 20;
  data = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0};
  put_signal(data, layout, 0xABCDE);
  EXPECT_EQ(data, (CanData{0xFF, 0xEF, 0xCD, 0xAB, 0xFF, 0, 0, 0}));

  layout.byte_order = ByteOrder::big_endian;
  layout.start_bit = 11;  // the fourth bit of the second byte downwards
  layout.length = 12;
  data = {};
  put_signal(data, layout, 0xABC);
  EXPECT_EQ(data, (CanData{0, 0x0A, 0xBC, 0, 0, 0, 0, 0}));
}

/// Straight on at 1 m/s for 20 s, level or up a slope of one to ten; or straight back again.
Motion straight(double slope, double metres_a_second = 1) {
  std::vector<Pose> knots;
  for (int i = 0; i <= 8000; ++i) {
    const double x = metres_a_second * 0.0025 * i * std::cos(std::atan(slope));
    knots.push_back({{x, 0, slope * x}, from_roll_pitch_yaw(0, -std::atan(slope), 0)});
  }
  return {std::move(knots), 0, 2'500'000};
}

double counted(const Motion& motion, const SimulatedEncoderSettings& settings) {
  EncoderSettings layout;
  layout.length = 16;  // wraps after 10 m
  SimulatedEncoder encoder(motion, layout, settings, 1);
  const auto count = [&](std::int64_t t) {
    const CanData data = encoder.frame(t);
    return static_cast<std::uint16_t>(data[0] | data[1] << 8);
  };
  std::int64_t sum = 0;
  std::uint16_t before = count(0);
  for (std::int64_t t = 0; t <= 20'000'000'000; t += 10'000'000) {
    const std::uint16_t now = count(t);
    sum += static_cast<std::int16_t>(now - before);
    before = now;
  }
  return static_cast<double>(sum) * layout.scale;
}

TEST(SimulatedEncoder, CountsTheWayThroughItsWraps) {
  SimulatedEncoderSettings settings{.scale_error = 0, .slope_slip = 0, .bursts_a_minute = 0};
  EXPECT_NEAR(counted(straight(0), settings), 20, 0.001);
  settings.scale_error = 0.008;
  EXPECT_NEAR(counted(straight(0), settings), 20 * 1.008, 0.001);
}

TEST(SimulatedEncoder, CountsDownWhenTheRobotDrivesBackwards) {
  SimulatedEncoderSettings settings{.scale_error = 0, .slope_slip = 0, .bursts_a_minute = 0};
  EXPECT_NEAR(counted(straight(0, -1), settings), -20, 0.001);
  // Backwards down a slope the wheel turns less than it moves.
  settings.slope_slip = 0.05;
  EXPECT_NEAR(counted(straight(0.1, -1), settings), -20 * (1 - 0.05 * 0.0995), 0.002);
}

TEST(SimulatedEncoder, SlipsUphillAndInBursts) {
  SimulatedEncoderSettings settings{.scale_error = 0, .slope_slip = 0.05, .bursts_a_minute = 0};
  EXPECT_NEAR(counted(straight(0.1), settings), 20 * (1 + 0.05 * 0.0995), 0.002);
  settings = {.scale_error = 0, .slope_slip = 0, .bursts_a_minute = 20};
  const double turned = counted(straight(0), settings);
  EXPECT_GT(turned, 20.05);
  EXPECT_LT(turned, 20 + 20 * 0.3);
}

TEST(SimulatedEncoder, SendsSpeed) {
  const Motion motion = straight(0);
  EncoderSettings layout;
  layout.kind = EncoderKind::speed;
  layout.length = 16;
  layout.scale = 0.001;
  SimulatedEncoder encoder(motion, layout,
                           {.scale_error = 0, .slope_slip = 0, .bursts_a_minute = 0}, 1);
  encoder.frame(1'000'000'000);
  const CanData data = encoder.frame(1'010'000'000);
  EXPECT_EQ(data[0] | data[1] << 8, 1000);
}

}  // namespace
}  // namespace scree
