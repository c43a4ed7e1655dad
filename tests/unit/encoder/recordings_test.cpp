// Real recordings (and one made by another simulator), kept outside the project.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
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
  const auto filled = with_dbc(settings, shared("can"));
  EXPECT_TRUE(filled) << filled.error().message;
  return filled.value_or(settings);
}

/// Four signals of 15 bits, big-endian, each beginning in the middle of a byte: the wheels of one
/// car roll nearly the same way, and its own speedometer agrees.
TEST(Recordings, FourWheelsOfACarAgree) {
  NEEDS("can/car_wheel_speeds.log");
  std::array<double, 4> ways{};
  std::size_t i = 0;
  for (const char* name :
       {"WHEEL_SPEED_FL", "WHEEL_SPEED_FR", "WHEEL_SPEED_RL", "WHEEL_SPEED_RR"}) {
    const Played played =
        play("can/car_wheel_speeds.log", wheel(std::string("WHEEL_SPEEDS.") + name));
    EXPECT_EQ(played.counters.accepted, 353U) << name;
    EXPECT_EQ(played.counters.all_refused(), 0U) << name;
    EXPECT_EQ(played.counters.other, 12000U - 353U) << name;
    ways[i++] = played.samples.back().distance;
  }
  const Played speedometer = play("can/car_wheel_speeds.log", wheel("ENGINE_DATA.XMISSION_SPEED"));
  EXPECT_GT(ways[0], 5);
  for (const double way : ways) {
    EXPECT_NEAR(way / ways[0], 1, 0.02);
    EXPECT_NEAR(way / speedometer.samples.back().distance, 1, 0.05);
  }
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
