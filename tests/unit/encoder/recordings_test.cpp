// Real recordings (and one made by another simulator), kept outside the project.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scree/capture/can_log.hpp"
#include "scree/drivers/encoder/dbc.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"
#include "unit/recordings.hpp"

namespace scree::encoder {
namespace {

struct Played {
  std::vector<EncoderSample> samples;
  EncoderCounters counters;
};

Played play(const char* name, const EncoderSettings& settings) {
  Played played;
  auto log = CanLogReader::open(shared(name));
  EXPECT_TRUE(log) << log.error().message;
  EncoderStream stream(settings,
                       [&](const EncoderSample& sample) { played.samples.push_back(sample); });
  CanFrame frame;
  while (log->next(frame)) stream.take(frame);
  EXPECT_EQ(log->counters().all_refused(), 0U);
  played.counters = stream.counters();
  return played;
}

EncoderSettings wheel(const std::string& signal) {
  EncoderSettings settings;
  settings.dbc = "car_wheel_speeds.dbc";
  settings.signal = signal;
  settings.kind = EncoderKind::speed;
  settings.scale = 1 / 3.6;
  settings.max_speed = 70;
  const auto filled = with_dbc(settings, shared("can/robot.toml"));
  EXPECT_TRUE(filled) << filled.error().message;
  return filled.value_or(settings);
}

/// Four signals of 15 bits, big-endian, one behind the other from the highest bit of the frame.
TEST(Recordings, WheelSpeedsOfACarAreReadBitForBit) {
  NEEDS("can/car_wheel_speeds.log");
  unsigned shift = 64;
  for (const char* name :
       {"WHEEL_SPEED_FL", "WHEEL_SPEED_FR", "WHEEL_SPEED_RL", "WHEEL_SPEED_RR"}) {
    shift -= 15;
    auto log = CanLogReader::open(shared("can/car_wheel_speeds.log"));
    ASSERT_TRUE(log);
    std::uint64_t word = 0;
    int read = 0;
    EncoderStream stream(wheel(std::string("WHEEL_SPEEDS.") + name), {}, [&](const Reading& r) {
      EXPECT_EQ(static_cast<std::uint64_t>(r.raw), (word >> shift) & 0x7FFFU);
      EXPECT_DOUBLE_EQ(r.value, static_cast<double>(r.raw) * 0.01 / 3.6);
      ++read;
    });
    for (CanFrame frame; log->next(frame);) {
      word = 0;
      for (std::size_t i = 0; i < 8; ++i) word = word << 8U | frame.data[i];
      stream.take(frame);
    }
    EXPECT_EQ(read, 353) << name;
  }
}

/// In a bend the outer wheels roll further than the inner ones, and the car's own speedometer lies
/// between them.
TEST(Recordings, WheelsOfACarRollNearlyTheSameWay) {
  NEEDS("can/car_wheel_speeds.log");
  const auto way = [](const std::string& signal) {
    const Played played = play("can/car_wheel_speeds.log", wheel(signal));
    EXPECT_EQ(played.counters.all_refused(), 0U) << signal;
    EXPECT_EQ(played.counters.rebased, 0U) << signal;
    EXPECT_EQ(played.counters.accepted + played.counters.other, 12000U) << signal;
    return played.samples.back().distance;
  };
  const double left = way("WHEEL_SPEEDS.WHEEL_SPEED_RL"),
               right = way("WHEEL_SPEEDS.WHEEL_SPEED_RR");
  EXPECT_GT(right, 5);
  EXPECT_NEAR(left / right, 1, 0.1);
  EXPECT_NEAR(way("WHEEL_SPEEDS.WHEEL_SPEED_FL") / left, 1, 0.06);
  EXPECT_NEAR(way("WHEEL_SPEEDS.WHEEL_SPEED_FR") / right, 1, 0.06);
  EXPECT_NEAR(2 * way("ENGINE_DATA.XMISSION_SPEED") / (left + right), 1, 0.06);
}

TEST(Recordings, AnotherSimulatorsCounterIsTakenWhole) {
  NEEDS("captures/interop/can.log");
  const Played played = play("captures/interop/can.log", {});
  EXPECT_EQ(played.counters.all_refused(), 0U);
  EXPECT_EQ(played.counters.rebased, 0U);
  ASSERT_GT(played.counters.accepted, 500U);
  const EncoderSample &first = played.samples.front(), &last = played.samples.back();
  EXPECT_NEAR(last.distance, static_cast<double>(last.raw - first.raw) * 0.000157, 1e-9);
  EXPECT_GT(last.distance, 1);
}

}  // namespace
}  // namespace scree::encoder
